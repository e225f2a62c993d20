// SPDX-License-Identifier: Apache-2.0
#include "files/clip_output.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <sstream>
#include <utility>

#include "files/alembic/alembic_clip.h"
#include "files/alembic/alembic_writer.h"
#include "files/clip_offset.h"
#include "files/gltf/gltf_clip.h"
#include "files/gltf/gltf_writer.h"
#include "files/mesh_file.h"
#include "files/overwriting.h"
#include "files/path.h"
#include "files/usd_writer.h"
#include "files/vat_writer.h"

namespace sac {

namespace {

bool IsSceneName(const std::string& path) {
  return IsAlembicName(path) || IsGltfName(path) || IsUsdName(path) || IsVatName(path);
}

}  // namespace

bool ClipOutput::IsClipName(const std::string& path) {
  return IsCacheName(path) || IsSceneName(path) || IsWritableMeshName(path);
}

std::string ClipOutput::NameError(const std::string& path) {
  return path +
         ": not a clip by its name (.pc2, .mdd, .abc, .glb, .gltf, .usda, .vat, or a pattern of .obj, .ply or .off)";
}

Status ClipOutput::Open(const std::string& path, const Mesh& mesh, const Settings& settings,
                        std::unique_ptr<ClipOutput>& output) {
  if (!IsClipName(path)) {
    return Status::InvalidArgument(NameError(path));
  }
  auto opened = std::make_unique<ClipOutput>();
  opened->path_ = path;
  opened->TakeMesh(mesh);
  opened->force_ = settings.force;
  opened->obj_ = settings.obj;
  opened->offset_ = settings.offset;
  opened->precision_ = settings.precision;
  if (IsSceneName(path)) {
    SAC_RETURN_IF_ERROR(opened->OpenScene(settings));
  } else if (IsCacheName(path)) {
    SAC_RETURN_IF_ERROR(
        CacheWriter::Open(path, mesh.positions.size(), settings.fps, settings.frame_count, opened->cache_));
  } else if (FramePattern::IsPattern(path)) {
    SAC_RETURN_IF_ERROR(FramePattern::Parse(path, opened->pattern_.emplace()));
    if (opened->pattern_->any_digits()) {
      return Status::InvalidArgument(path + ": * is for reading; write the frame number as %d or %04d");
    }
  }
  output = std::move(opened);
  return Status::Ok();
}

void ClipOutput::TakeMesh(const Mesh& mesh) {
  mesh_ = mesh;
  normals_.emplace(mesh);
  if (!mesh.normals.empty()) mesh_.normal_triangles = normals_->normal_triangles();
}

Status ClipOutput::BeginMesh(std::int64_t number, const Mesh& mesh) {
  if (!pattern_) {
    return Status::Unsupported(path_ + ": holds one mesh, and the mesh changes at frame " + std::to_string(number) +
                               "; write a sequence of meshes, such as frame_%04d.obj, or the --frames of each mesh");
  }
  TakeMesh(mesh);
  return Status::Ok();
}

Status ClipOutput::OpenScene(const Settings& settings) {
  if (IsAlembicName(path_)) {
    auto alembic = std::make_unique<AlembicWriter>();
    SAC_RETURN_IF_ERROR(alembic->Open(path_, mesh_, {settings.fps, settings.offset}));
    scene_ = std::move(alembic);
    return Status::Ok();
  }
  if (IsVatName(path_)) {
    auto vat = std::make_unique<VatWriter>();
    SAC_RETURN_IF_ERROR(vat->Open(path_, mesh_, {settings.fps, settings.offset, settings.exr, settings.force}));
    scene_ = std::move(vat);
    return Status::Ok();
  }
  if (IsUsdName(path_)) {
    auto usd = std::make_unique<UsdWriter>();
    SAC_RETURN_IF_ERROR(usd->Open(path_, mesh_, {settings.fps, settings.offset, settings.z_up}));
    scene_ = std::move(usd);
    return Status::Ok();
  }
  GltfOutput output{settings.fps, settings.offset, GltfCompression::kNone};
  if (settings.compression == Compression::kQuantized) output.compression = GltfCompression::kQuantized;
  if (settings.compression == Compression::kMeshopt) output.compression = GltfCompression::kMeshopt;
  auto writer = std::make_unique<GltfWriter>();
  SAC_RETURN_IF_ERROR(writer->Open(path_, mesh_, output));
  scene_ = std::move(writer);
  return Status::Ok();
}

Status ClipOutput::WriteMeshFile(const std::string& path, const Positions& positions, bool named) {
  mesh_.positions = positions;
  mesh_.normals = normals_->Compute(positions);
  std::string bytes;
  Warnings warnings;
  if (obj_ != nullptr && Extension(path) == ".obj") {
    bytes = obj_->Format(positions, offset_);
    // A normal of the text may serve several vertices, which turn each its own way.
    if (!obj_->normals().empty() && pattern_) {
      warnings.push_back(path + ": its normals are those of the mesh it was made onto, in every frame");
    }
  } else {
    SAC_RETURN_IF_ERROR(FormatMesh(path, mesh_, offset_, bytes, warnings));
  }
  if (!named && !force_) SAC_RETURN_IF_ERROR(CheckUnnamed(path, bytes));
  if (mesh_warnings_.empty()) mesh_warnings_ = std::move(warnings);
  OutputFile file;
  SAC_RETURN_IF_ERROR(file.Open(path));
  SAC_RETURN_IF_ERROR(file.Write(bytes));
  SAC_RETURN_IF_ERROR(file.Close());
  mesh_files_.push_back(std::move(file));
  return Status::Ok();
}

Status ClipOutput::Write(std::int64_t number, const Positions& positions) {
  if (positions.size() != mesh_.positions.size()) {
    return Status::InvalidArgument(path_ + ": a frame of " + std::to_string(positions.size()) + " vertices, not " +
                                   std::to_string(mesh_.positions.size()));
  }
  if (scene_) return scene_->Write(number, positions, normals_->Compute(positions));
  if (pattern_) {
    last_number_ = std::max(last_number_, number);
    return WriteMeshFile(pattern_->Path(number), positions, true);
  }
  if (!cache_) {
    if (!mesh_files_.empty()) {
      return Status::InvalidArgument(path_ + ": more than one frame needs a cache or a pattern such as x_%04d.obj");
    }
    return WriteMeshFile(path_, positions, true);
  }
  if (mesh_files_.empty()) {
    SAC_RETURN_IF_ERROR(
        WriteMeshFile(std::filesystem::path(path_).replace_extension(".obj").string(), positions, false));
  }
  return WriteToCache(number, positions);
}

Status ClipOutput::WriteToCache(std::int64_t number, const Positions& positions) {
  if (offset_ == std::array<double, 3>{}) return cache_->Write(positions);
  Positions moved = positions;
  for (std::size_t v = 0; v < moved.size(); ++v) {
    const Vec3d sum = Absolute(offset_, positions[v]);
    for (std::size_t a = 0; a < 3; ++a) {
      moved[v][a] = static_cast<float>(sum[a]);
      if (!std::isfinite(moved[v][a])) {
        return Status::InvalidArgument(path_ + ": frame " + std::to_string(number) + ": vertex " + std::to_string(v) +
                                       " is beyond the range of the format's 32-bit floats; meshes (.obj) hold it");
      }
      largest_rounding_ = std::max(largest_rounding_, std::abs(static_cast<double>(moved[v][a]) - sum[a]));
    }
  }
  return cache_->Write(moved);
}

Warnings ClipOutput::warnings() const {
  if (scene_) return scene_->warnings();
  Warnings warnings = mesh_warnings_;
  if (largest_rounding_ > precision_) {
    std::ostringstream text;
    text << path_ << ": the format's 32-bit floats round the coordinates by up to " << largest_rounding_
         << "; meshes (.obj, .ply, .off) hold them exactly";
    warnings.push_back(text.str());
  }
  return warnings;
}

Warnings ClipOutput::StaleFrames() const {
  std::map<std::int64_t, std::string> files;
  if (!pattern_ || !pattern_->List(files).ok()) return {};
  files.erase(files.begin(), files.upper_bound(last_number_));
  if (files.empty()) return {};
  const std::string first = std::to_string(files.begin()->first);
  const std::string numbers = files.size() == 1 ? first : first + " to " + std::to_string(files.rbegin()->first);
  return {path_ + ": frames " + numbers + " are there from before and do not belong to this clip"};
}

Status ClipOutput::Commit() {
  if (scene_) return scene_->Commit();
  if (mesh_files_.empty()) return Status::InvalidArgument(path_ + ": no frames");
  // The cache first: its last write may still find the disk full, the mesh files are closed.
  if (cache_) SAC_RETURN_IF_ERROR(cache_->Commit());
  for (OutputFile& file : mesh_files_) SAC_RETURN_IF_ERROR(file.Commit());
  return Status::Ok();
}

}  // namespace sac

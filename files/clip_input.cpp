// SPDX-License-Identifier: Apache-2.0
#include "files/clip_input.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "files/alembic/alembic_clip.h"
#include "files/cache_match.h"
#include "files/clip_offset.h"
#include "files/frame_rate.h"
#include "files/gltf/gltf_clip.h"
#include "files/path.h"
#include "files/usd_writer.h"

namespace sac {
namespace {

template <std::size_t N>
Status CheckFinite(const std::vector<std::array<float, N>>& values, const std::string& where) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const float x : values[i]) {
      if (!std::isfinite(x)) return Status::InvalidArgument(where + " " + std::to_string(i) + ": not a finite number");
    }
  }
  return Status::Ok();
}

Status CheckAttributes(const Mesh& mesh, const std::string& path) {
  SAC_RETURN_IF_ERROR(CheckFinite(mesh.normals, path + ": normal"));
  return CheckFinite(mesh.uvs, path + ": texture coordinates");
}

Status CheckPositions(const MeshFile& file, const std::string& path) {
  if (file.not_finite.empty()) return Status::Ok();
  return Status::InvalidArgument(path + ": " + file.not_finite + ": not a finite number");
}

Status CheckCacheFrame(const Positions& positions, const std::string& path, std::uint32_t frame) {
  return CheckFinite(positions, path + ": frame " + std::to_string(frame) + ", vertex");
}

}  // namespace

Status ClipInput::Open(const std::vector<std::string>& arguments, std::unique_ptr<ClipInput>& input,
                       const ClipInputSettings& settings) {
  if (arguments.empty()) return Status::InvalidArgument("no input");
  auto opened = std::make_unique<ClipInput>();
  opened->settings_ = settings;
  opened->name_ = arguments[0];
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (const std::string error = UsdInputError(arguments[i]); !error.empty()) return Status::Unsupported(error);
    if (IsCacheName(arguments[i]) && !(i == 1 && arguments.size() == 2)) {
      return Status::InvalidArgument(arguments[i] + ": a cache comes alone after its mesh file");
    }
  }
  if (arguments.size() == 2 && IsCacheName(arguments[1])) {
    SAC_RETURN_IF_ERROR(opened->OpenCache(arguments[0], arguments[1]));
  } else if (arguments.size() == 1 && IsGltfName(arguments[0])) {
    SAC_RETURN_IF_ERROR(
        OpenGltfClip(arguments[0], {settings.rate, settings.animation, settings.scene}, opened->scene_));
    SAC_RETURN_IF_ERROR(opened->BeginSegment(0));
  } else if (arguments.size() == 1 && IsAlembicName(arguments[0])) {
    SAC_RETURN_IF_ERROR(OpenAlembicClip(arguments[0], settings.rate, opened->scene_));
    SAC_RETURN_IF_ERROR(opened->BeginSegment(0));
  } else {
    FrameSequence sequence;
    SAC_RETURN_IF_ERROR(FindSequence(arguments, settings.gaps, sequence, opened->warnings_));
    opened->paths_ = std::move(sequence.paths);
    SAC_RETURN_IF_ERROR(opened->OpenSequence());
  }
  input = std::move(opened);
  return Status::Ok();
}

Status ClipInput::OpenCache(const std::string& mesh_path, const std::string& cache_path) {
  SAC_RETURN_IF_ERROR(ReadMeshFile(mesh_path, {}, file_));
  SAC_RETURN_IF_ERROR(CheckAttributes(file_.mesh, mesh_path));
  SAC_RETURN_IF_ERROR(CacheReader::Open(cache_path, cache_, settings_.skip_damage));
  Mesh& mesh = file_.mesh;
  if (cache_->point_count() != mesh.positions.size()) {
    return Status::InvalidArgument(cache_path + ": " + std::to_string(cache_->point_count()) + " points, but " +
                                   mesh_path + " has " + std::to_string(mesh.positions.size()) + " vertices");
  }
  warnings_ = file_.warnings;
  warnings_.insert(warnings_.end(), cache_->warnings().begin(), cache_->warnings().end());
  Positions frame;
  SAC_RETURN_IF_ERROR(cache_->Read(0, frame));
  SAC_RETURN_IF_ERROR(CheckCacheFrame(frame, cache_path, 0));
  if (IsLikelyInAnotherOrder(mesh, frame)) {
    warnings_.push_back(cache_path + ": edges of the mesh are many times as long in it: are the vertices of " +
                        mesh_path + " in another order than those of the cache?");
  }
  TellCoarse(frame, cache_path);
  offset_ = settings_.offset.value_or(Vec3d{});
  file_.exact = {};
  mesh.positions = std::move(frame);
  Subtract(offset_, mesh.positions);
  return Status::Ok();
}

Status ClipInput::OpenSequence() {
  if (paths_.size() > std::numeric_limits<std::uint32_t>::max()) return Status::Limit(paths_[0] + ": too many frames");
  return BeginSegment(0);
}

Status ClipInput::ReadFirst() {
  if (scene_) return scene_->ReadMesh(first_, file_);
  const bool stl =
      std::all_of(paths_.begin(), paths_.end(), [](const auto& path) { return Extension(path) == ".stl"; });
  welding_.reset();
  return stl && paths_.size() > 1 ? WeldSegment(first_) : ReadMeshFile(paths_[first_], {}, file_);
}

Status ClipInput::BeginSegment(std::uint32_t first) {
  first_ = next_ = first;
  const std::string path = name_of(first);
  SAC_RETURN_IF_ERROR(ReadFirst());
  SAC_RETURN_IF_ERROR(CheckAttributes(file_.mesh, path));
  SAC_RETURN_IF_ERROR(CheckPositions(file_, path));
  if (begun_) {
    TellLosses(file_, path);
  } else {
    warnings_.insert(warnings_.begin(), file_.warnings.begin(), file_.warnings.end());
    for (const std::string& warning : file_.warnings) told_losses_.insert(warning.substr(path.size()));
    offset_ = settings_.offset.value_or(ChooseOffset(file_.exact));
  }
  begun_ = true;
  file_.mesh.positions = Relative(file_, offset_);
  file_.exact = {};
  TellCoarse(file_.mesh.positions, path);
  return Status::Ok();
}

// Reads all frames of a segment for what is one vertex in each of them, and then the first.
Status ClipInput::WeldSegment(std::uint32_t first) {
  Welding welding;
  std::size_t corners = 0, first_vertices = 0;
  for (std::uint32_t f = first; f < paths_.size(); ++f) {
    const std::string& path = paths_[f];
    MeshFile soup;
    SAC_RETURN_IF_ERROR(ReadMeshFile(path, {.weld = false}, soup));
    const std::size_t count = soup.mesh.positions.size();
    if (f == first) corners = count;
    if (count != corners) {
      const std::string difference = path + ": " + std::to_string(count / 3) + " triangles, but " + paths_[first] +
                                     " has " + std::to_string(corners / 3);
      if (!settings_.segments) return Status::InvalidArgument(difference);
      EndSegment(f, difference);
      break;
    }
    SAC_RETURN_IF_ERROR(CheckPositions(soup, path));
    welding.Add(DoublePositions(soup));
    if (f == first) first_vertices = welding.size();
  }
  if (welding.size() > first_vertices && !begun_) {
    warnings_.push_back(paths_[first] + ": corners of triangles that meet in it part in later frames: " +
                        std::to_string(welding.size()) + " vertices and not " + std::to_string(first_vertices));
  }
  welding_ = std::move(welding);
  return ReadFrame(first, file_);
}

Status ClipInput::ReadFrame(std::uint32_t index, MeshFile& file) const {
  const MeshFile* const first = index == first_ ? nullptr : &file_;
  if (!welding_) return ReadMeshFile(paths_[index], {.first = first}, file);
  SAC_RETURN_IF_ERROR(ReadMeshFile(paths_[index], {.weld = false}, file));
  if (file.mesh.positions.size() != welding_->vertices().size()) {
    return Status::InvalidArgument(paths_[index] + ": changed while it was read");
  }
  file.mesh.positions = welding_->Gather(file.mesh.positions);
  if (!file.exact.empty()) file.exact = welding_->Gather(file.exact);
  file.faces.vertices = welding_->vertices();
  for (std::size_t j = 0; j < file.corners.size(); ++j) {
    for (int k = 0; k < 3; ++k) file.mesh.triangles[j][k] = file.faces.vertices[file.corners[j][k]];
  }
  return Status::Ok();
}

void ClipInput::Tell(bool& told, const std::string& warning) {
  if (!told) warnings_.push_back(warning);
  told = true;
}

void ClipInput::TellLosses(const MeshFile& file, const std::string& path) {
  constexpr std::size_t kMostTold = 16;
  for (const std::string& warning : file.warnings) {
    // The same of another file is no news.
    if (told_losses_.size() < kMostTold && told_losses_.insert(warning.substr(path.size())).second) {
      warnings_.push_back(warning);
    }
  }
}

void ClipInput::TellChanges(const MeshFile& file, const std::string& path) {
  const Mesh &mesh = file.mesh, &first = file_.mesh;
  const auto warning = [&](const std::string& what) {
    return path + ": its " + what + " are not those of " + paths_[first_] + ", which every frame gets";
  };
  if (mesh.colors != first.colors) Tell(told_colors_, warning("colors"));
  if (mesh.uvs != first.uvs || mesh.uv_triangles != first.uv_triangles) {
    Tell(told_uvs_, warning("texture coordinates"));
  }
  if (mesh.normals.empty() != first.normals.empty() || mesh.normal_triangles != first.normal_triangles) {
    Tell(told_normals_, warning("hard edges (corners with normals of their own)"));
  }
}

void ClipInput::TellCoarse(const Positions& frame, const std::string& where) {
  if (told_coarse_) return;
  if (const double step = CoarseStep(frame, diagonal_); step > 0) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", step);
    Tell(told_coarse_, where + ": float32 has steps of " + text +
                           " at its distance from the origin; move the mesh to the origin before the export");
  }
}

FrameRate ClipInput::rate() const {
  if (scene_) return scene_->rate();
  const std::optional<double> fps = cache_ ? cache_->fps() : std::nullopt;
  return fps ? NearestFrameRate(*fps) : FrameRate{};
}

std::string ClipInput::name_of(std::uint32_t frame) const {
  if (scene_) return name_;
  return cache_ ? cache_->path() : paths_[frame];
}

std::optional<std::uint32_t> ClipInput::frame_count() const { return frames(); }

Status ClipInput::Rewind() {
  if (first_ != 0) return BeginSegment(0);
  next_ = 0;
  return Status::Ok();
}

void ClipInput::EndSegment(std::uint32_t next, const std::string& reason) {
  constexpr std::size_t kMostTold = 3;
  if (!ends_.insert(next).second || ends_.size() > kMostTold) return;
  warnings_.push_back(reason + "; a segment begins with it" +
                      (ends_.size() == kMostTold ? ", and with others, which are not told" : ""));
}

Status ClipInput::NextSegment(bool& end) {
  end = true;
  if (cache_) return Status::Ok();
  // Frames are read for where the segment ends, unless that is known.
  Positions ignored;
  for (bool at_end = false; !at_end && ends_.upper_bound(first_) == ends_.end();) {
    SAC_RETURN_IF_ERROR(Next(ignored, at_end));
  }
  const std::uint32_t next = *ends_.upper_bound(first_);
  end = next == frames();
  return end ? Status::Ok() : BeginSegment(next);
}

std::uint32_t ClipInput::frames() const {
  if (scene_) return scene_->frame_count();
  return cache_ ? cache_->frame_count() : static_cast<std::uint32_t>(paths_.size());
}

Status ClipInput::NextOfSequence(Positions& frame, bool& end) {
  const std::string& path = paths_[next_];
  MeshFile file;
  SAC_RETURN_IF_ERROR(ReadFrame(next_, file));
  const Mesh& first = file_.mesh;
  std::string difference;
  if (file.mesh.positions.size() != first.positions.size()) {
    difference = path + ": " + std::to_string(file.mesh.positions.size()) + " vertices, but " + paths_[first_] +
                 " has " + std::to_string(first.positions.size());
  } else if (file.faces != file_.faces) {
    difference = path + ": its faces are not those of " + paths_[first_];
  }
  if (!difference.empty() && !settings_.segments) return Status::InvalidArgument(difference);
  if (!difference.empty()) {
    EndSegment(next_, difference);
    end = true;
    return Status::Ok();
  }
  SAC_RETURN_IF_ERROR(CheckPositions(file, path));
  TellChanges(file, path);
  TellLosses(file, path);
  frame = Relative(file, offset_);
  TellCoarse(frame, path);
  return Status::Ok();
}

Status ClipInput::NextOfScene(Positions& frame, bool& end) {
  MeshFile file;
  const Status read = scene_->ReadPositions(next_, first_, file);
  if (read.code() == StatusCode::kUnsupported && settings_.segments) {
    EndSegment(next_, read.message());
    end = true;
    return Status::Ok();
  }
  SAC_RETURN_IF_ERROR(read);
  const std::string where = name_ + ": frame " + std::to_string(next_);
  SAC_RETURN_IF_ERROR(CheckPositions(file, where));
  frame = Relative(file, offset_);
  TellCoarse(frame, where);
  return Status::Ok();
}

Status ClipInput::Next(Positions& frame, bool& end) {
  if (next_ == frames()) ends_.insert(next_);
  end = next_ > first_ && ends_.contains(next_);
  if (end) return Status::Ok();
  if (next_ == first_) {
    frame = file_.mesh.positions;
  } else if (cache_) {
    SAC_RETURN_IF_ERROR(cache_->Read(next_, frame));
    SAC_RETURN_IF_ERROR(CheckCacheFrame(frame, cache_->path(), next_));
    TellCoarse(frame, cache_->path() + ": frame " + std::to_string(next_));
    Subtract(offset_, frame);
  } else if (scene_) {
    SAC_RETURN_IF_ERROR(NextOfScene(frame, end));
  } else {
    SAC_RETURN_IF_ERROR(NextOfSequence(frame, end));
  }
  if (end) return Status::Ok();
  ++next_;
  return Status::Ok();
}

}  // namespace sac

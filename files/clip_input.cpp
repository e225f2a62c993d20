// SPDX-License-Identifier: Apache-2.0
#include "files/clip_input.h"

#include <cmath>
#include <limits>
#include <utility>

#include "files/frame_rate.h"
#include "files/mesh_file.h"

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

Status CheckCacheFrame(const Positions& positions, const std::string& path, std::uint32_t frame) {
  return CheckFinite(positions, path + ": frame " + std::to_string(frame) + ", vertex");
}

}  // namespace

Status ClipInput::Open(const std::vector<std::string>& arguments, const Settings& settings,
                       std::unique_ptr<ClipInput>& input) {
  if (arguments.empty()) return Status::InvalidArgument("no input");
  auto opened = std::make_unique<ClipInput>();
  opened->name_ = arguments[0];
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (IsCacheName(arguments[i]) && !(i == 1 && arguments.size() == 2)) {
      return Status::InvalidArgument(arguments[i] + ": a cache comes alone after its mesh file");
    }
  }
  if (arguments.size() == 2 && IsCacheName(arguments[1])) {
    SAC_RETURN_IF_ERROR(opened->OpenCache(arguments[0], arguments[1]));
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
  SAC_RETURN_IF_ERROR(ReadMesh(mesh_path, mesh_));
  SAC_RETURN_IF_ERROR(CheckAttributes(mesh_, mesh_path));
  SAC_RETURN_IF_ERROR(CacheReader::Open(cache_path, cache_));
  if (cache_->point_count() != mesh_.positions.size()) {
    return Status::InvalidArgument(cache_path + ": " + std::to_string(cache_->point_count()) + " points, but " +
                                   mesh_path + " has " + std::to_string(mesh_.positions.size()) + " vertices");
  }
  SAC_RETURN_IF_ERROR(cache_->Read(0, mesh_.positions));
  return CheckCacheFrame(mesh_.positions, cache_path, 0);
}

Status ClipInput::OpenSequence() {
  if (paths_.size() > std::numeric_limits<std::uint32_t>::max()) return Status::Limit(paths_[0] + ": too many frames");
  SAC_RETURN_IF_ERROR(ReadMesh(paths_[0], mesh_));
  SAC_RETURN_IF_ERROR(CheckAttributes(mesh_, paths_[0]));
  return CheckFinite(mesh_.positions, paths_[0] + ": vertex");
}

FrameRate ClipInput::rate() const {
  const std::optional<double> fps = cache_ ? cache_->fps() : std::nullopt;
  return fps ? NearestFrameRate(*fps) : FrameRate{};
}

std::optional<std::uint32_t> ClipInput::frame_count() const { return frames(); }

Status ClipInput::Rewind() {
  next_ = 0;
  return Status::Ok();
}

std::uint32_t ClipInput::frames() const {
  return cache_ ? cache_->frame_count() : static_cast<std::uint32_t>(paths_.size());
}

Status ClipInput::Next(Positions& frame, bool& end) {
  end = next_ == frames();
  if (end) return Status::Ok();
  if (next_ == 0) {
    frame = mesh_.positions;
  } else if (cache_) {
    SAC_RETURN_IF_ERROR(cache_->Read(next_, frame));
    SAC_RETURN_IF_ERROR(CheckCacheFrame(frame, cache_->path(), next_));
  } else {
    const std::string& path = paths_[next_];
    Mesh mesh;
    SAC_RETURN_IF_ERROR(ReadMesh(path, mesh));
    if (mesh.positions.size() != mesh_.positions.size()) {
      return Status::InvalidArgument(path + ": " + std::to_string(mesh.positions.size()) + " vertices, but " +
                                     paths_[0] + " has " + std::to_string(mesh_.positions.size()));
    }
    if (mesh.triangles != mesh_.triangles) {
      return Status::InvalidArgument(path + ": its triangles are not those of " + paths_[0]);
    }
    SAC_RETURN_IF_ERROR(CheckFinite(mesh.positions, path + ": vertex"));
    frame = std::move(mesh.positions);
  }
  ++next_;
  return Status::Ok();
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files/cache_file.h"
#include "files/frame_sequence.h"
#include "files/warnings.h"
#include "sac/clip.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// The encoder's input: the frames of a clip one after the other, each with the vertices of the first and finite.
// Memory is one frame, whatever their number. Every message starts with the path of the file at fault.
class ClipInput : public ClipReader {
 public:
  struct Settings {
    Gaps gaps = Gaps::kError;
  };

  // `arguments` are `mesh.EXT cache.pc2|.mdd`, or what FindSequence() takes: one or several mesh files, a pattern such
  // as `frame_%04d.ply`, or a directory. Reads the first frame.
  static Status Open(const std::vector<std::string>& arguments, const Settings& settings,
                     std::unique_ptr<ClipInput>& input);

  // What the files hold and the clip does not, so far.
  const Warnings& warnings() const { return warnings_; }

  // The first frame: triangles and attributes of the (first) mesh file; with a cache, the positions are the cache's.
  const Mesh& mesh() const override { return mesh_; }

  // An MDD has times, from which the rate is derived; other inputs have none.
  FrameRate rate() const override;

  // At least 1.
  std::optional<std::uint32_t> frame_count() const override;

  // The first file.
  std::string name() const override { return name_; }
  // The cache, or the frame's own file.
  std::string name_of(std::uint32_t frame) const override { return cache_ ? cache_->path() : paths_[frame]; }

  // kInvalidArgument for another number of vertices, other triangles, or a coordinate that is NaN or infinite.
  Status Next(Positions& frame, bool& end) override;
  Status Rewind() override;

 private:
  Status OpenCache(const std::string& mesh_path, const std::string& cache_path);
  Status OpenSequence();

  std::uint32_t frames() const;

  std::string name_;
  Mesh mesh_;
  Warnings warnings_;
  std::vector<std::string> paths_;  // of a sequence
  std::unique_ptr<CacheReader> cache_;
  std::uint32_t next_ = 0;
};

}  // namespace sac

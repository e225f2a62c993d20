// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "files/mesh_file.h"
#include "sac/clip.h"
#include "sac/status.h"

namespace sac {

// A file that holds a whole clip: meshes, which become one, and how they move, sampled at frames. Messages start with
// the path of the file.
class SceneReader {
 public:
  virtual ~SceneReader() = default;

  // That of the frames; unknown where nothing moves and none was asked for.
  virtual FrameRate rate() const = 0;
  // At least 1.
  virtual std::uint32_t frame_count() const = 0;

  // Reads a frame, 0 to frame_count() - 1, with all that it has; file.warnings are about the whole clip.
  virtual Status ReadMesh(std::uint32_t frame, MeshFile& file) = 0;

  // Reads the positions of a frame into file.mesh.positions, file.exact and file.not_finite. kUnsupported where
  // vertices or faces are not those of the frame `first`.
  virtual Status ReadPositions(std::uint32_t frame, std::uint32_t first, MeshFile& file) = 0;
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "files/warnings.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// A file, or a few, that hold a whole clip: the mesh and all its frames. Messages start with the path of the file.
class SceneWriter {
 public:
  virtual ~SceneWriter() = default;

  // Appends a frame with `number`: its positions, and its normals in the order of the mesh's, if that has any.
  virtual Status Write(std::int64_t number, const Positions& positions, const std::vector<Vec3f>& normals) = 0;
  // Gives the files their names. There must have been a frame.
  virtual Status Commit() = 0;
  // What the files do not hold of the clip.
  virtual Warnings warnings() const { return {}; }
};

}  // namespace sac

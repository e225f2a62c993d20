// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// The normals of the vertices: means of the normals of the triangles around a vertex, weighted by area, of length 1.
// The normal of a vertex without area around it is zero.
std::vector<Vec3f> VertexNormals(const Positions& positions, const std::vector<Triangle>& triangles);

// Computes the normals of one frame after another in memory that it keeps. Those of sac/frame_normals.h have creases.
class NormalField {
 public:
  // The normals of `positions`, as VertexNormals() gives them, valid until the next call.
  const std::vector<Vec3f>& Compute(const Positions& positions, const std::vector<Triangle>& triangles);

 private:
  std::vector<std::array<double, 3>> sums_;  // of the normals of the triangles around a vertex, twice their area long
  std::vector<Vec3f> normals_;
};

}  // namespace sac

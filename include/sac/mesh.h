// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace sac {

using Vec3f = std::array<float, 3>;
using Triangle = std::array<std::uint32_t, 3>;

// One frame's vertex positions, in model units.
using Positions = std::vector<Vec3f>;

// The axis-aligned box [low, high], model units.
struct Box {
  std::array<double, 3> low = {}, high = {};

  std::array<double, 3> size() const { return {high[0] - low[0], high[1] - low[1], high[2] - low[2]}; }
  double diagonal() const { return std::sqrt(size()[0] * size()[0] + size()[1] * size()[1] + size()[2] * size()[2]); }
};

// An indexed triangle mesh with the static attributes of a clip. Any list of triangles is a mesh: several
// components, boundaries, non-manifold edges, isolated vertices and degenerate or duplicate triangles are all allowed.
struct Mesh {
  Positions positions;
  std::vector<Triangle> triangles;  // vertex indices

  // Texture coordinates belong to corners: uv_triangles[j][k] indexes uvs for corner k of triangle j.
  // Both are empty when there are none.
  std::vector<std::array<float, 2>> uvs;
  std::vector<Triangle> uv_triangles;

  // Per vertex, or, where corners of a vertex have normals of their own (hard edges), per corner:
  // normal_triangles[j][k] indexes normals for corner k of triangle j, and is empty otherwise. Both are empty when
  // there are none. A decoded mesh has normals of corners only where the corners of a vertex differ; a vertex without
  // corners has none then.
  std::vector<Vec3f> normals;
  std::vector<Triangle> normal_triangles;

  std::vector<std::array<std::uint8_t, 4>> colors;  // RGBA, per vertex; empty when there are none
};

}  // namespace sac

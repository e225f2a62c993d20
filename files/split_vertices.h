// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// The vertices of a mesh for formats, and graphics hardware, that have one normal and one pair of texture coordinates a
// vertex: the mesh's own come first and in their order, and where corners of a vertex differ, others follow.
struct SplitVertices {
  std::vector<std::uint32_t> vertices;  // of the mesh, for each
  std::vector<std::uint32_t> uvs;       // indices of the mesh's, for each; empty without
  std::vector<std::uint32_t> normals;   // indices of the mesh's, for each; empty without
  std::vector<Triangle> triangles;      // of these vertices, in the order of the mesh's

  std::size_t size() const { return vertices.size(); }
};

// A vertex without corners gets the first texture coordinates, and the first of the normals of corners.
SplitVertices SplitAtSeams(const Mesh& mesh);

}  // namespace sac

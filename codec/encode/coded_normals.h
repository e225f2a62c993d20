// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sac/mesh.h"

namespace sac {

// The bits of each of the two numbers that Draco makes of a normal.
inline constexpr int kNormalBits = 9;

// The normals of a mesh as an I-frame codes them.
struct CodedNormals {
  std::vector<Vec3f> values;        // one a vertex, or those of corners; empty without normals
  std::vector<Triangle> triangles;  // per corner the index of its value; empty when they are those of vertices
};

// Joins normals of a vertex's corners that become equal when they are quantized, or differ by no more than rounding, so
// that no seam is coded between them. Vertices without corners get zeros where the normals are given for corners.
CodedNormals NormalsToCode(const Mesh& mesh);

// One normal a vertex: that of its first corner where normals are of corners; zero without one.
std::vector<Vec3f> NormalsOfVertices(const Mesh& mesh, const CodedNormals& normals);

}  // namespace sac

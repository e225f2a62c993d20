// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// Corners of triangles by what they share: corner k of triangle j has the number 3 * j + k.
struct CornerGroups {
  std::vector<Triangle> triangles;  // per corner its group; groups are numbered in the order of their first corners
  std::vector<std::size_t> first;   // per group its first corner
};

// Puts two corners into one group if they have the same vertex and the same class. `vertices` and `classes` hold those
// of each triangle's corners.
CornerGroups GroupCorners(const std::vector<Triangle>& vertices, const std::vector<Triangle>& classes);

// One number for the normals with the same bits, for each normal.
std::vector<std::uint32_t> ClassesByBits(const std::vector<Vec3f>& normals);

// Brings normals of corners into the form that a Mesh has them in. Two normals are the same if they are of one class:
// `classes` has one a normal.
//
// Where the corners of each vertex agree, `normals` become those of the vertices and `normal_triangles` empty; a vertex
// without corners takes its normal of `loose`, which is empty, for zeros, or has one a vertex. Elsewhere each pair of a
// vertex and a class becomes one normal, in the order of first corners.
void MergeNormals(const std::vector<Triangle>& triangles, std::size_t vertices,
                  const std::vector<std::uint32_t>& classes, const std::vector<Vec3f>& loose,
                  std::vector<Vec3f>& normals, std::vector<Triangle>& normal_triangles);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// A mesh as it is coded, in which vertices of the author's that coincide are one. Where none do, it is the author's.
struct JoinedMesh {
  Mesh mesh;  // without colours; normals are of corners where vertices are joined that have some
  std::vector<std::uint32_t> vertex_of_author;      // of each of the author's vertices
  std::vector<Triangle> author_triangles;           // of the author's vertices
  std::vector<std::array<std::uint8_t, 4>> colors;  // of vertices, the first of those joined; empty without colours
  // Where joined vertices differ in colour, those of corners: color_triangles indexes them, and is empty elsewhere.
  std::vector<std::array<std::uint8_t, 4>> corner_colors;
  std::vector<Triangle> color_triangles;
  std::vector<Vec3f> own_normals;  // of vertices, where the author's are of vertices

  std::size_t authors() const { return vertex_of_author.size(); }
  bool is_joined() const { return mesh.positions.size() < authors(); }
};

// kInvalidArgument when `lowest` is not what JoinVertices() takes for a mesh of `vertices` vertices.
Status CheckJoining(std::span<const std::uint32_t> lowest, std::size_t vertices);

// Joins the vertices that coincide: `lowest` has for each vertex the lowest that it coincides with; empty: none do.
// Vertices stay apart that have no triangle of three different places, and so are, after joining, no corner of a
// triangle that Draco can code: their attributes would be lost.
JoinedMesh JoinVertices(const Mesh& mesh, std::span<const std::uint32_t> lowest);

}  // namespace sac

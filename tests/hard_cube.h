// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "sac/mesh.h"

namespace sac {

// A cube of 8 vertices, from (0, 0, 0) to (1, 1, 1), whose 6 faces have a normal each: all edges are hard.
inline Mesh HardCubeMesh() {
  Mesh mesh;
  mesh.normals = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
  for (std::uint32_t v = 0; v < 8; ++v) {
    mesh.positions.push_back({static_cast<float>(v / 4), static_cast<float>(v / 2 % 2), static_cast<float>(v % 2)});
  }
  const std::array<std::array<std::uint32_t, 4>, 6> faces = {
      {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}};
  for (std::uint32_t f = 0; f < 6; ++f) {
    const auto& q = faces[f];
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
    mesh.normal_triangles.insert(mesh.normal_triangles.end(), 2, {f, f, f});
  }
  return mesh;
}

}  // namespace sac

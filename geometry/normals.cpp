// SPDX-License-Identifier: Apache-2.0
#include "geometry/normals.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace sac {

const std::vector<Vec3f>& NormalField::Compute(const Positions& positions, const std::vector<Triangle>& triangles) {
  sums_.assign(positions.size(), {});
  for (const Triangle& t : triangles) {
    std::array<double, 3> u, w;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto origin = static_cast<double>(positions[t[0]][a]);
      u[a] = static_cast<double>(positions[t[1]][a]) - origin;
      w[a] = static_cast<double>(positions[t[2]][a]) - origin;
    }
    for (std::size_t a = 0; a < 3; ++a) {  // twice the area long
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      const double n = u[b] * w[c] - u[c] * w[b];
      for (const std::uint32_t corner : t) sums_[corner][a] += n;
    }
  }
  normals_.assign(positions.size(), {});
  for (std::size_t v = 0; v < sums_.size(); ++v) {
    const double length = std::hypot(sums_[v][0], sums_[v][1], sums_[v][2]);
    if (!(length > 0) || !std::isfinite(length)) continue;
    for (std::size_t a = 0; a < 3; ++a) normals_[v][a] = static_cast<float>(sums_[v][a] / length);
  }
  return normals_;
}

std::vector<Vec3f> VertexNormals(const Positions& positions, const std::vector<Triangle>& triangles) {
  NormalField field;
  return field.Compute(positions, triangles);
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// The median length of the triangles' edges, in the unit of `positions`; an edge of two triangles counts twice. 0
// without any.
template <class Real>
double MedianEdge(std::span<const std::array<Real, 3>> positions, std::span<const Triangle> triangles) {
  std::vector<double> lengths;
  lengths.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto &a = positions[t[k]], &b = positions[t[(k + 1) % 3]];
      const auto along = [&](std::size_t axis) { return static_cast<double>(a[axis]) - static_cast<double>(b[axis]); };
      lengths.push_back(std::hypot(along(0), along(1), along(2)));
    }
  }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace sac

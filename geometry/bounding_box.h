// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "sac/mesh.h"

namespace sac {

// The smallest axis-aligned box around `positions`, model units. Without positions it is the origin.
inline Box BoundingBox(std::span<const Vec3f> positions) {
  Box box;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto x = static_cast<double>(positions[v][a]);
      box.low[a] = v == 0 ? x : std::min(box.low[a], x);
      box.high[a] = v == 0 ? x : std::max(box.high[a], x);
    }
  }
  return box;
}

// The smallest box around both.
inline Box Union(const Box& x, const Box& y) {
  Box box;
  for (std::size_t a = 0; a < 3; ++a) {
    box.low[a] = std::min(x.low[a], y.low[a]);
    box.high[a] = std::max(x.high[a], y.high[a]);
  }
  return box;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "sac/mesh.h"

namespace sac {

// The smallest axis-aligned box around `positions`, model units. Without positions it is the origin.
inline Box BoundingBox(const Positions& positions) {
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

}  // namespace sac

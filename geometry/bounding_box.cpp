#include "geometry/bounding_box.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sac {

double Box::diagonal() const {
  const std::array<double, 3> s = size();
  return std::sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
}

Box BoundingBox(const Positions& positions) {
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

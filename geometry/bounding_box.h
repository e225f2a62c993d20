#pragma once

#include <array>

#include "geometry/mesh.h"

namespace sac {

struct Box {
  std::array<double, 3> low = {}, high = {};

  double diagonal() const;
  std::array<double, 3> size() const { return {high[0] - low[0], high[1] - low[1], high[2] - low[2]}; }
};

// A point at the origin for no positions.
Box BoundingBox(const Positions& positions);

}  // namespace sac

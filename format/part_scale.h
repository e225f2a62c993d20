// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "format/grid_position.h"

namespace sac {

// The largest exponent of a PartScale.
inline constexpr std::uint32_t kMaxPartExponent = 20;

// How much finer a component's grid and steps are than the mesh's (spec.md 5.2): by 2^exponent.
struct PartScale {
  std::uint32_t exponent = 0;
  GridPosition origin = {};  // of the component's grid, in places of the mesh's; zeros where the exponent is 0

  double factor() const { return std::ldexp(1.0, -static_cast<int>(exponent)); }
};

}  // namespace sac

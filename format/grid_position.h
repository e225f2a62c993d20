// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace sac {

// The position of a vertex of the first frame on the grid of the sequence header, in cells from its origin along each
// axis (spec.md 5.3).
using GridPosition = std::array<std::uint32_t, 3>;

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "sac/mesh.h"

namespace sac {

// OpenMesh's writers know coordinates of 32 bits alone. These take what they have written of vertices at `positions`
// and replace the coordinates by the sums with `offset`, in double precision.

// Of an ASCII OFF file; the sums have the digits that bring back the identical double.
std::string MoveOff(std::string_view text, const Positions& positions, const std::array<double, 3>& offset);

// Of a binary PLY file, little endian, whose vertices begin with x, y and z; these become properties of type double.
std::string MovePly(std::string_view bytes, const Positions& positions, const std::array<double, 3>& offset);

}  // namespace sac

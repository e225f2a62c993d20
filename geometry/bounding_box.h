// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sac/mesh.h"

namespace sac {

// The smallest axis-aligned box around `positions`, model units. Without positions it is the origin.
Box BoundingBox(const Positions& positions);

}  // namespace sac

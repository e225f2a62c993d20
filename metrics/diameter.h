// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sac/mesh.h"

namespace sac {

// The largest distance between two of the points, 0 for fewer than two points. It is exact up to the rounding of one
// distance, and NaN if a coordinate is not finite. Time is O(n) for most shapes, about O(n log n) for spheres and other
// shapes with very many almost farthest pairs.
double Diameter(const Positions& points);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "format/references.h"

namespace sac {

// Lists references that may serve a frame better than those of its group's structure: no reference, for a cut, and the
// best single frames and pairs among the frames coded before, for motion that repeats. `coded` is the number of frames
// of the group that are coded. `motion_bits` estimates the bits of the motion plane with given references. References
// that cost more than `limit` bits are left out.
std::vector<References> LikelyReferences(std::uint32_t coded,
                                         const std::function<double(const References&)>& motion_bits, double limit);

}  // namespace sac

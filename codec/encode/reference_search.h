// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "format/references.h"

namespace sac {

// References that may serve a frame better than those of its group's structure: none, for a cut, and the likeliest
// single frames and pairs of what is coded, for motion that comes again. `coded`: how many frames of the group there
// are. `motion_bits`: what the motion plane would cost. Those that cost more than `most` are left out.
std::vector<References> LikelyReferences(std::uint32_t coded,
                                         const std::function<double(const References&)>& motion_bits, double most);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "sac/clip.h"

namespace sac {

// Reads `24`, `30000/1001` or a decimal. A decimal of two or more digits after the point that is a multiple of
// 1000/1001, rounded, means that one: 29.97 is 30000/1001, 23.976 and 23.98 are 24000/1001. Any other decimal is taken
// at its word. False for anything else, for zero, and for what does not fit.
bool ParseFrameRate(std::string_view text, FrameRate& rate);

// The rate that `fps`, measured from times in float32, most likely stands for; unknown unless it is positive and
// finite.
FrameRate NearestFrameRate(double fps);

}  // namespace sac

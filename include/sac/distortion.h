// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace sac {

// The distortion of a decoded animation against its original.
struct DistortionMetrics {
  // Percent of the original's own spread (Karni and Gotsman 2004). Infinite only if the original has no spread; write
  // null in JSON.
  double kg = 0;
  double sted = 0;       // spatio-temporal edge difference without unit (Vasa and Skala 2011), of the next two
  double sted_s = 0;     // its spatial part
  double sted_t = 0;     // its temporal part; 0 with a single frame
  double max_error = 0;  // largest distance between a vertex and its decoded position, model units
  std::size_t frames = 0;
};

}  // namespace sac

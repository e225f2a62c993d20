// SPDX-License-Identifier: Apache-2.0
#include "metrics/error_meter.h"

#include <cassert>
#include <cmath>

namespace sac {

ErrorMeter::ErrorMeter(std::vector<Triangle> triangles, std::size_t vertices)
    : spatial_(triangles, vertices), temporal_(vertices), parts_(triangles, vertices) {}

void ErrorMeter::Add(const Positions& original, const Positions& decoded) {
  assert(original.size() == decoded.size());
  kg_.Add(original, decoded);
  spatial_.Add(original, decoded);
  temporal_.Add(original, decoded);
  seam_gap_.Add(original, decoded);
  parts_.Add(original, decoded);
  for (std::size_t v = 0; v < original.size(); ++v) {
    double d2 = 0;
    for (int c = 0; c < 3; ++c) {
      const double d = double{original[v][c]} - decoded[v][c];
      d2 += d * d;
    }
    if (d2 > max_error2_ || std::isnan(d2)) max_error2_ = d2;  // a NaN stays: no comparison with it holds
  }
  ++frames_;
}

DistortionMetrics ErrorMeter::Result() const {
  DistortionMetrics m;
  m.kg = kg_.Value();
  m.sted_s = spatial_.Value();
  m.sted_t = temporal_.Value();
  m.sted = std::hypot(m.sted_s, kStedWeight * m.sted_t);
  m.max_error = std::sqrt(max_error2_);
  m.seam_gap = seam_gap_.Value();
  m.worst_part = parts_.Worst();
  m.frames = frames_;
  return m;
}

}  // namespace sac

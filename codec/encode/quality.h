// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "codec/encode/operating_point.h"

namespace sac {

// The quality from which streams have a detail plane. Where the number of harmonics is capped, detail begins a little
// earlier.
inline constexpr double kDetailQuality = 75;

// How many harmonics a mesh takes, 200 at least.
struct HarmonicLimits {
  // Where more pay less than detail does: in a small mesh they approach a code for every vertex.
  double useful;
  // Where decoders would take too long to start, or too much memory, with more: in a large mesh. What comes short of
  // them is still better than detail.
  double quick;

  double most() const { return useful < quick ? useful : quick; }
};
HarmonicLimits HarmonicLimitsOf(std::uint32_t vertices);

// `quality` from 0 to 100, and beyond with the last rows' ratios: from a table measured on several clips
// (docs/quality.md), interpolated between those of its rows that have no more than `limits.useful` harmonics; the
// result has no more than `limits.quick`.
OperatingPoint PointOfQuality(double quality, const HarmonicLimits& limits);

// The same without a detail plane: beyond kDetailQuality the other steps become finer instead.
OperatingPoint SmoothPointOfQuality(double quality, double max_harmonics);

}  // namespace sac

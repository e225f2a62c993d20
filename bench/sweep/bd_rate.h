// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

namespace sac {

// A point of a rate-distortion curve.
struct RatePoint {
  double rate;        // above 0
  double distortion;  // above 0
};

// How much more of a rate another codec takes than a reference, on the average over the distortions that both reach.
struct BdRate {
  double percent;    // 0: as much, 100: twice as much
  double low, high;  // the distortions over which it is the mean
};

// The Bjontegaard delta rate (VCEG-M33, 2001) with monotone cubics through the logarithms of rate over distortion, as
// JCT-VC computes it. Points that another point beats or equals in both are left out: a curve is what its codec can do.
// Nothing if a curve has fewer than two points then, or the curves have no distortion in common.
std::optional<BdRate> BjontegaardRate(const std::vector<RatePoint>& reference, const std::vector<RatePoint>& other);

}  // namespace sac

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

// How much more rate a codec takes than a reference, as a mean over the distortions that both reach.
struct BdRate {
  double percent;    // 0: the same rate, 100: twice the rate
  double low, high;  // range of distortions of the mean
};

// The Bjontegaard delta rate (VCEG-M33, 2001) with monotone cubics through the logarithms of rate over distortion, as
// JCT-VC computes it. Points for which another point of the curve is at least as good in both rate and distortion are
// left out. The result is empty if a curve then has fewer than two points or the curves have no distortion in common.
std::optional<BdRate> BjontegaardRate(const std::vector<RatePoint>& reference, const std::vector<RatePoint>& other);

}  // namespace sac

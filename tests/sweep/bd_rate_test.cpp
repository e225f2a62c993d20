// SPDX-License-Identifier: Apache-2.0
#include "bench/sweep/bd_rate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace sac {
namespace {

using Curve = std::vector<RatePoint>;

const Curve kReference{{0.05, 4.0}, {0.1, 1.9}, {0.2, 1.0}, {0.4, 0.45}, {0.9, 0.11}};

Curve Times(Curve curve, double factor) {
  for (RatePoint& p : curve) p.rate *= factor;
  return curve;
}

TEST(BdRate, OfTheSameCurveAtMoreBits) {
  EXPECT_NEAR(BjontegaardRate(kReference, kReference)->percent, 0, 1e-9);
  const auto rate = BjontegaardRate(kReference, Times(kReference, 3));
  EXPECT_NEAR(rate->percent, 200, 1e-9);
  EXPECT_NEAR(rate->low, 0.11, 1e-12);
  EXPECT_NEAR(rate->high, 4, 1e-12);
  EXPECT_NEAR(BjontegaardRate(Times(kReference, 3), kReference)->percent, -200.0 / 3, 1e-9);
}

// Against scipy.interpolate.PchipInterpolator over the logarithms, integrated from 0.3 to 3.
TEST(BdRate, OfCurvesThatPartlyOverlap) {
  const auto rate = BjontegaardRate(kReference, {{0.3, 3.0}, {0.5, 1.5}, {1.4, 0.4}, {2.0, 0.3}});
  EXPECT_NEAR(rate->percent, 257.28021691372993, 1e-7);
  EXPECT_NEAR(rate->low, 0.3, 1e-12);
  EXPECT_NEAR(rate->high, 3, 1e-12);
}

// Rates that are powers of the distortion: 0.2 / d against 0.5 / d^2, whose ratio's logarithm is log 2.5 - log d.
TEST(BdRate, OfPowerLaws) {
  Curve a, b;
  for (const double d : {4.0, 2.0, 1.0, 0.5}) {
    a.push_back({0.2 / d, d});
    b.push_back({0.5 / (d * d), d});
  }
  const double mean_log = (std::log(4.0) + std::log(0.5)) / 2;
  EXPECT_NEAR(BjontegaardRate(a, b)->percent, 100 * (2.5 * std::exp(-mean_log) - 1), 1e-9);
}

TEST(BdRate, LeavesOutWhatIsBeaten) {
  Curve worse = kReference;
  worse.push_back({0.3, 1.2});  // more bits than 0.2, more error than 1.0
  worse.push_back({0.2, 1.5});  // as many bits, more error
  worse.push_back({80, 0});     // exact: no logarithm
  worse.push_back({0.01, INFINITY});
  EXPECT_NEAR(BjontegaardRate(kReference, worse)->percent, 0, 1e-9);
}

TEST(BdRate, NeedsACommonRange) {
  EXPECT_FALSE(BjontegaardRate(kReference, {{1, 0.1}, {2, 0.01}}));
  EXPECT_FALSE(BjontegaardRate(kReference, {{1, 1}}));
  EXPECT_FALSE(BjontegaardRate({}, kReference));
  EXPECT_TRUE(BjontegaardRate(kReference, {{1, 0.2}, {2, 0.01}}));
}

}  // namespace
}  // namespace sac

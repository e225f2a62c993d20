// SPDX-License-Identifier: Apache-2.0
#include "metrics/diameter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace sac {
namespace {

double SlowDiameter(const Positions& points) {
  double best = 0;
  for (const Vec3f& p : points) {
    for (const Vec3f& q : points) {
      best = std::max(best, std::hypot(double{p[0]} - q[0], double{p[1]} - q[1], double{p[2]} - q[2]));
    }
  }
  return best;
}

Positions Cloud(std::size_t n, std::mt19937& random) {
  Positions p(n);
  for (Vec3f& q : p) {
    for (float& x : q) x = static_cast<float>(random() / 2147483648.0 - 1);
  }
  return p;
}

Vec3f Normalized(const Vec3f& p) {
  const float norm = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  return {p[0] / norm, p[1] / norm, p[2] / norm};
}

TEST(Diameter, OfFewPoints) {
  EXPECT_EQ(Diameter({}), 0);
  EXPECT_EQ(Diameter({{1, 2, 3}}), 0);
  EXPECT_EQ(Diameter({{1, 2, 3}, {1, 5, 7}}), 5);
  EXPECT_EQ(Diameter(Positions(100, {1, 2, 3})), 0);
}

TEST(Diameter, IsExact) {
  std::mt19937 random(5);
  for (int i = 0; i < 60; ++i) {
    Positions p = Cloud(1 + random() % 400, random);
    for (Vec3f& q : p) {
      if (i % 2 == 0) q = Normalized(q);
      if (i % 3 == 0) q[2] = 0;                                              // a disc
      if (i % 4 == 0) q[0] = std::max(q[0], 0.5f);                           // a cut
      if (i % 5 == 0) q = {q[0] * 0.01f + 1000, q[1] * 0.02f, q[2] + 1000};  // far away
    }
    EXPECT_NEAR(Diameter(p), SlowDiameter(p), 1e-15 * SlowDiameter(p));
  }
}

TEST(Diameter, IsQuickOnASphere) {
  // All pairs of a hundred thousand points would take half a minute.
  std::mt19937 random(6);
  Positions p = Cloud(100000, random);
  for (Vec3f& q : p) q = Normalized(q);
  EXPECT_NEAR(Diameter(p), 2, 1e-6);
}

TEST(Diameter, OfNaNIsNaN) {
  Positions p(50, {1, 2, 3});
  p[20][1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(Diameter(p)));
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "player/camera.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace sac {
namespace {

// A point in the picture: x and y from -1 to 1, and the depth.
std::array<double, 3> Project(const Camera& camera, const std::array<double, 3>& point) {
  const auto apply = [](const Matrix4& m, const std::array<double, 4>& v) {
    std::array<double, 4> out{};
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 4; ++c) out[r] += double{m[4 * c + r]} * v[c];
    }
    return out;
  };
  const auto p = apply(camera.Projection(1), apply(camera.View(), {point[0], point[1], point[2], 1}));
  return {p[0] / p[3], p[1] / p[3], p[2] / p[3]};
}

TEST(Camera, ShowsTheWholeBoxFromEverySide) {
  const Box box{{1, 2, 3}, {3, 8, 4}};
  for (const bool z_up : {false, true}) {
    Camera camera;
    camera.z_up = z_up;
    camera.Fit(box);
    for (int side = 0; side < 16; ++side) {
      camera.Orbit(0.7, 0.11);
      for (int corner = 0; corner < 8; ++corner) {
        const auto at = Project(camera, {corner & 1 ? 1.0 : 3, corner & 2 ? 2.0 : 8, corner & 4 ? 3.0 : 4});
        for (const double x : at) EXPECT_LE(std::abs(x), 1);
      }
      const auto middle = Project(camera, {2, 5, 3.5});
      EXPECT_NEAR(middle[0], 0, 1e-5);
      EXPECT_NEAR(middle[1], 0, 1e-5);
    }
  }
}

TEST(Camera, WhatIsUpIsUpAndIsNotMirrored) {
  for (const bool z_up : {false, true}) {
    Camera camera;
    camera.z_up = z_up;
    for (int side = 0; side < 9; ++side) {
      camera.Orbit(0.7, 0);
      const auto above = Project(camera, z_up ? std::array<double, 3>{0, 0, 0.1} : std::array<double, 3>{0, 0.1, 0});
      EXPECT_GT(above[1], 0.05);
      EXPECT_NEAR(above[0], 0, 1e-5);
      // The axes of a right-handed system: right, up, towards the eye.
      const auto r = camera.right(), u = camera.up(), b = camera.backward();
      EXPECT_NEAR(
          r[0] * (u[1] * b[2] - u[2] * b[1]) - r[1] * (u[0] * b[2] - u[2] * b[0]) + r[2] * (u[0] * b[1] - u[1] * b[0]),
          1, 1e-9);
    }
    camera.Pan(0.1, 0.2);
    const auto at = Project(camera, {0, 0, 0});
    EXPECT_NEAR(at[0], -0.2, 1e-5);
    EXPECT_NEAR(at[1], -0.4, 1e-5);
  }
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "geometry/deformation.h"

#include <gtest/gtest.h>

#include "tests/test_meshes.h"

namespace sac {
namespace {

TEST(RotationOf, IsARotationAtEveryAngle) {
  std::mt19937 random(1);
  for (const double angle : {0.0, 1e-300, 1e-12, 1e-8, 0.99e-4, 1.01e-4, 0.1, 3.0, std::numbers::pi, 6.2, 100.0, 1e6}) {
    const Eigen::Vector3d axis = RandomVector(random).normalized();
    const Eigen::Matrix3d r = RotationOf(angle * axis);
    EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-13) << angle;
    EXPECT_GT(r.determinant(), 0) << angle;
    EXPECT_LT((r - AxisAngle(axis, angle)).cwiseAbs().maxCoeff(), angle > 1e3 ? 1e-9 : 1e-13) << angle;
  }
}

TEST(RotationOf, AQuarterTurn) {
  const Eigen::Matrix3d r = RotationOf({0, 0, std::numbers::pi / 2});
  EXPECT_LT((r * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(-2, 1, 3)).norm(), 1e-14);
}

TEST(DeformationGradient, StretchesAndThenRotates) {
  const double still[9] = {};
  EXPECT_EQ(DeformationGradient(still), Eigen::Matrix3d::Identity());
  const double channels[9] = {0, 0, std::numbers::pi / 2, 1, -0.5, 0.25, 0.1, 0.2, 0.3};
  Eigen::Matrix3d stretch;
  stretch << 2, 0.1, 0.2, 0.1, 0.5, 0.3, 0.2, 0.3, 1.25;
  const Eigen::Vector3d x(1, -2, 3), s = stretch * x;
  EXPECT_LT((DeformationGradient(channels) * x - Eigen::Vector3d(-s[1], s[0], s[2])).norm(), 1e-13);
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "geometry/rigid_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/test_meshes.h"

namespace sac {
namespace {

PositionMatrix Cloud(Eigen::Index n, std::mt19937& random) {
  PositionMatrix p(n, 3);
  for (Eigen::Index v = 0; v < n; ++v) p.row(v) = RandomVector(random).transpose();
  return p;
}

PositionMatrix Apply(const RigidFit& fit, const PositionMatrix& p, const Eigen::RowVector3d& centre) {
  return Moved(p.rowwise() - centre, fit.rotation, centre.transpose() + fit.translation);
}

void ExpectRotation(const Eigen::Matrix3d& r) {
  EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  EXPECT_NEAR(r.determinant(), 1, 1e-9);
}

TEST(RigidFit, RecoversARigidMotion) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    PositionMatrix p = Cloud(3 + i, random);
    if (i % 2 == 0) p.col(i % 3).setConstant(0.7);  // a planar shape
    const Eigen::Matrix3d r = AxisAngle(RandomVector(random), 3.1 * Signed(random));
    const Eigen::RowVector3d centre = RandomVector(random).transpose();
    const Eigen::Vector3d t = 10 * RandomVector(random);
    const PositionMatrix q = Moved(p.rowwise() - centre, r, centre.transpose() + t);
    const RigidFit fit = FitRigid(p, q, centre);
    EXPECT_LT((fit.rotation - r).norm(), 1e-6);
    EXPECT_LT((fit.translation - t).norm(), 1e-6);
    EXPECT_LT(fit.residual, 1e-8);
  }
}

TEST(RigidFit, IsNearestAmongItsNeighbours) {
  std::mt19937 random(2);
  const PositionMatrix p = Cloud(30, random), q = p + 0.5 * Cloud(30, random);
  const Eigen::RowVector3d centre(1, 2, 3);
  const RigidFit best = FitRigid(p, q, centre);
  const double distance = (Apply(best, p, centre) - q).norm();
  EXPECT_NEAR(best.residual, distance / std::sqrt(30.0), 1e-9);
  for (int i = 0; i < 200; ++i) {
    RigidFit other = best;
    other.rotation = AxisAngle(RandomVector(random), 1e-3) * best.rotation;
    other.translation += 1e-3 * RandomVector(random);
    EXPECT_GT((Apply(other, p, centre) - q).norm(), distance);
  }
}

TEST(RigidFit, OfPointsAndLinesIsStillAMotion) {
  const Eigen::RowVector3d centre(0, 0, 1);
  PositionMatrix point(1, 3), moved(1, 3);
  point << 1, 2, 3;
  moved << 4, 4, 4;
  const RigidFit single = FitRigid(point, moved, centre);
  ExpectRotation(single.rotation);
  EXPECT_LT((Apply(single, point, centre) - moved).norm(), 1e-12);

  PositionMatrix line(10, 3);
  for (Eigen::Index v = 0; v < 10; ++v) line.row(v) << 1.0 * static_cast<double>(v), 2, 3;
  const PositionMatrix turned = Moved(line, AxisAngle({0, 1, 1}, 2), {1, 1, 1});
  const RigidFit fit = FitRigid(line, turned, centre);
  ExpectRotation(fit.rotation);
  EXPECT_LT((Apply(fit, line, centre) - turned).norm(), 1e-8);
}

TEST(RigidFit, NeverMirrors) {
  std::mt19937 random(3);
  const PositionMatrix p = Cloud(20, random);
  PositionMatrix mirrored = p;
  mirrored.col(0) *= -1;
  ExpectRotation(FitRigid(p, mirrored, Eigen::RowVector3d::Zero()).rotation);
}

}  // namespace
}  // namespace sac

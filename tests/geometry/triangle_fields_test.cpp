// SPDX-License-Identifier: Apache-2.0
#include "geometry/triangle_fields.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "geometry/deformation.h"
#include "tests/test_meshes.h"

namespace sac {
namespace {

Eigen::Matrix3d RandomMatrix(std::mt19937& random) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i) m.col(i) = RandomVector(random);
  return m;
}

TEST(PolarRotation, AgreesWithAnSvd) {
  std::mt19937 random(1);
  int turned_inside_out = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Matrix3d j = RandomMatrix(random) * std::pow(10.0, 5 * Signed(random));
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(j, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d s = svd.singularValues();
    if (s[1] < 1e-3 * s[0]) continue;  // badly determined
    Eigen::Vector3d signs = Eigen::Vector3d::Ones();
    if (j.determinant() < 0) {
      ++turned_inside_out;
      signs[2] = -1;
      if (s[1] - s[2] < 1e-3 * s[0]) continue;
    }
    const Eigen::Matrix3d expected = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    EXPECT_LT((PolarRotation(j) - expected).norm(), 1e-6);
  }
  EXPECT_GT(turned_inside_out, 100);
}

TEST(PolarRotation, IsARotationOfSingularMatrices) {
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    Eigen::Matrix3d j = RandomMatrix(random);
    if (i % 4 == 0) j.col(1) = j.col(0);
    if (i % 4 == 1) j = RandomVector(random) * RandomVector(random).transpose();
    if (i % 4 == 2) j.setZero();
    if (i % 4 == 3) j.col(2) *= 1e-9;
    const Eigen::Matrix3d r = PolarRotation(j);
    EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
    EXPECT_NEAR(r.determinant(), 1, 1e-9);
  }
}

TEST(UnwrappedLog, InvertsTheRotation) {
  std::mt19937 random(3);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d u = RandomVector(random).normalized() * (3.14 * std::abs(Signed(random)));
    EXPECT_LT((UnwrappedLog(RotationOf(u), Eigen::Vector3d::Zero()) - u).norm(), 1e-9);
  }
  EXPECT_EQ(UnwrappedLog(Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()), Eigen::Vector3d::Zero());
}

TEST(UnwrappedLog, FollowsManyTurnsForthAndBack) {
  std::mt19937 random(4);
  const Eigen::Vector3d axis = RandomVector(random).normalized();
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  for (int i = 0; i <= 400; ++i) {
    const double angle = 25 * std::sin(i * 2 * std::numbers::pi / 400);  // steps of up to 0.4
    u = UnwrappedLog(RotationOf(angle * axis), u);
    EXPECT_LT((u - angle * axis).norm(), 1e-6) << angle;
  }
}

TEST(UnwrappedLog, StaysAtWholeTurns) {
  const Eigen::Vector3d twice(0, 4 * std::numbers::pi, 0);
  EXPECT_LT((UnwrappedLog(Eigen::Matrix3d::Identity(), twice * 1.001) - twice).norm(), 1e-9);
}

TEST(TriangleFields, OfARotatedMeshAreThatRotation) {
  const Mesh mesh = SphereMesh(3);
  const PositionMatrix p = ToMatrix(mesh.positions);
  TriangleFields fields(mesh.triangles);
  const Eigen::Vector3d u(0.3, -1.1, 0.7);
  const Eigen::MatrixXd f = fields.Measure(p, Moved(p, AxisAngle(u, u.norm()), {5, 6, 7}));
  for (Eigen::Index j = 0; j < f.rows(); ++j) {
    EXPECT_LT((f.row(j).head<3>().transpose() - u).norm(), 1e-9);
    EXPECT_LT(f.row(j).tail<6>().norm(), 1e-9);
  }
  EXPECT_NEAR(fields.areas().sum(), 4 * std::numbers::pi, 0.5);
}

TEST(TriangleFields, OfAMovedMeshAreZero) {
  const Mesh mesh = PartsMesh();
  const PositionMatrix p = ToMatrix(mesh.positions);
  TriangleFields fields(mesh.triangles);
  EXPECT_LT(fields.Measure(p, Moved(p, Eigen::Matrix3d::Identity(), {1, -2, 3})).norm(), 1e-9);
}

TEST(TriangleFields, OfAStretchedSheetAreTheStretch) {
  // In the plane of the triangles; what happens along the normal is not stretched.
  const Mesh mesh = TubeMesh(4, 8);
  PositionMatrix p = ToMatrix(mesh.positions);
  p.col(0) = Eigen::VectorXd::LinSpaced(p.rows(), 0, 5).array().sin();  // anything
  p.col(1) = Eigen::VectorXd::LinSpaced(p.rows(), 0, 3).array().cos();
  p.col(2).setZero();
  PositionMatrix q = p;
  q.col(0) = 1.5 * p.col(0) + 0.2 * p.col(1);
  q.col(1) = 0.2 * p.col(0) + 0.8 * p.col(1);
  TriangleFields fields(mesh.triangles);
  const Eigen::MatrixXd f = fields.Measure(p, q);
  Eigen::Matrix<double, 9, 1> expected;
  expected << 0, 0, 0, 0.5, -0.2, 0, 0.2, 0, 0;
  int measured = 0;
  for (Eigen::Index j = 0; j < f.rows(); ++j) {
    if (fields.areas()[j] == 0) continue;
    ++measured;
    EXPECT_LT((f.row(j).transpose() - expected).norm(), 1e-6);
  }
  EXPECT_GT(measured, 20);
}

TEST(TriangleFields, GiveTheGradientOfEachEdge) {
  std::mt19937 random(5);
  const Mesh mesh = SphereMesh(2);
  const PositionMatrix p = ToMatrix(mesh.positions);
  PositionMatrix q = p;
  for (Eigen::Index v = 0; v < q.rows(); ++v) q.row(v) += 0.3 * RandomVector(random).transpose();
  TriangleFields fields(mesh.triangles);
  const Eigen::MatrixXd f = fields.Measure(p, q);
  for (Eigen::Index j = 0; j < f.rows(); ++j) {
    double channels[9];
    for (int c = 0; c < 9; ++c) channels[c] = f(j, c);
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(j)];
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d from = p.row(t[(k + 1) % 3]) - p.row(t[k]), to = q.row(t[(k + 1) % 3]) - q.row(t[k]);
      EXPECT_LT((DeformationGradient(channels) * from - to).norm(), 1e-9);
    }
  }
}

// A tube twisted by 0.8 turns, and a tube turned by nearly half a one that shivers: without a frame before, the
// rotations of neighbours agree all the same.
TEST(TriangleFields, AfterARestartAreUnwrappedOverTheSurface) {
  constexpr double kPi = std::numbers::pi;
  const Mesh tube = TubeMesh(40, 9);
  const PositionMatrix p = ToMatrix(tube.positions);
  for (const bool twisted : {true, false}) {
    std::mt19937 random(7);
    PositionMatrix q = p;
    for (Eigen::Index v = 0; v < q.rows(); ++v) {
      const double angle = twisted ? 1.6 * kPi * p(v, 2) / p.col(2).maxCoeff() : kPi + 0.03 * Signed(random);
      q.row(v) = p.row(v) * AxisAngle({0, 0, 1}, angle).transpose();
    }
    TriangleFields fields(tube.triangles);
    fields.Measure(p, Moved(p, AxisAngle({1, 2, 0}, 2), {0, 0, 0}));
    fields.Restart();
    const Eigen::MatrixXd f = fields.Measure(p, q);
    double most = 0, low = 100, high = -100;
    for (Eigen::Index j = 0; j < f.rows(); ++j) {
      low = std::min(low, f(j, 2));
      high = std::max(high, f(j, 2));
      for (Eigen::Index i = std::max<Eigen::Index>(0, j - 20); i < j; ++i) {
        most = std::max(most, (f.row(j) - f.row(i)).head<3>().norm());
      }
    }
    EXPECT_LT(most, 1.5);
    EXPECT_NEAR(high - low, twisted ? 1.6 * kPi : 0, 0.5);
    // It depends on the frame alone, and the next frame goes on from it.
    TriangleFields fresh(tube.triangles);
    fresh.Restart();
    EXPECT_EQ(fresh.Measure(p, q), f);
    EXPECT_LT((fields.Measure(p, q) - f).norm(), 1e-9);
  }
}

TEST(TriangleFields, LeaveOutDegenerateTriangles) {
  PositionMatrix p(5, 3);
  p << 0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, 1, 0, 0;
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {2, 2, 2}};  // a line, an edge, a point
  TriangleFields fields(triangles);
  const Eigen::MatrixXd f = fields.Measure(p, Moved(2 * p, AxisAngle({1, 0, 0}, 1), {0, 0, 0}));
  EXPECT_NEAR(fields.areas()[0], 0.5, 1e-12);
  EXPECT_GT(f.row(0).norm(), 1);
  for (Eigen::Index j = 1; j < 4; ++j) {
    EXPECT_EQ(fields.areas()[j], 0);
    EXPECT_EQ(f.row(j).norm(), 0);
  }
  // A triangle that collapses has a gradient all the same.
  const Eigen::MatrixXd collapsed = fields.Measure(p, PositionMatrix::Zero(5, 3));
  EXPECT_TRUE(collapsed.allFinite());
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "geometry/poisson_system.h"

#include <gtest/gtest.h>

#include "tests/test_meshes.h"

namespace sac {
namespace {

struct System {
  SequenceHeader header;
  Shape shape;
};

void Make(const Mesh& mesh, const std::vector<std::uint32_t>& counts, System& system) {
  MakeShape(mesh, counts, 0, 16, system.header, system.shape);
}

Eigen::RowVector3d Centroid(const Shape& shape, const Component& c, const PositionMatrix& p) {
  const auto mass = shape.masses.segment(c.first, c.count);
  return mass.transpose() * p.middleRows(c.first, c.count) / mass.sum();
}

TEST(PoissonSystem, ReproducesTheReference) {
  System s;
  Make(PartsMesh(), {2, 2, 2, 1}, s);
  PoissonSystem poisson(s.shape.edges, s.shape.components, s.shape.masses);
  ASSERT_TRUE(poisson.SetReference(s.shape.positions, s.shape.weights));
  const DeformationGradients still(s.shape.vertices(), Eigen::Matrix3d::Identity());
  EXPECT_LT((poisson.Solve(still) - s.shape.positions).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(PoissonSystem, TurnsEachComponentAboutItsCentroid) {
  System s;
  Make(PartsMesh(), {2, 2, 2, 1}, s);
  PoissonSystem poisson(s.shape.edges, s.shape.components, s.shape.masses);
  ASSERT_TRUE(poisson.SetReference(s.shape.positions, s.shape.weights));
  // Linear maps of their own: a rotation, a stretch, and anything.
  Eigen::Matrix3d any;
  any << 1, 2, 3, 0, -1, 4, 2, 0, 1;
  const Eigen::Matrix3d maps[] = {AxisAngle({1, 2, 3}, 2.5), 3 * Eigen::Matrix3d::Identity(), any, any};
  DeformationGradients gradients(s.shape.vertices());
  PositionMatrix expected(s.shape.positions.rows(), 3);
  for (std::size_t i = 0; i < s.shape.components.size(); ++i) {
    const Component& c = s.shape.components[i];
    std::fill_n(gradients.begin() + c.first, c.count, maps[i]);
    const Eigen::RowVector3d centre = Centroid(s.shape, c, s.shape.positions);
    expected.middleRows(c.first, c.count) =
        Moved(s.shape.positions.middleRows(c.first, c.count).rowwise() - centre, maps[i], centre.transpose());
  }
  EXPECT_LT((poisson.Solve(gradients) - expected).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(PoissonSystem, SolvesItsNormalEquations) {
  System s;
  Make(PartsMesh(), {2, 2, 2, 1}, s);
  PoissonSystem poisson(s.shape.edges, s.shape.components, s.shape.masses);
  ASSERT_TRUE(poisson.SetReference(s.shape.positions, s.shape.weights));
  std::mt19937 random(1);
  DeformationGradients gradients(s.shape.vertices());
  for (Eigen::Matrix3d& j : gradients) {
    j = AxisAngle(RandomVector(random), Signed(random)) + 0.2 * RandomVector(random) * RandomVector(random).transpose();
  }
  const PositionMatrix x = poisson.Solve(gradients);
  PositionMatrix slope = PositionMatrix::Zero(x.rows(), 3);
  for (std::size_t e = 0; e < s.shape.weights.size(); ++e) {
    const auto [a, b] = s.shape.edges.ends[e];
    const Eigen::Vector3d y = s.shape.positions.row(a) - s.shape.positions.row(b);
    const Eigen::Vector3d wanted = (gradients[a] + gradients[b]) / 2 * y;
    const Eigen::RowVector3d off = s.shape.weights[e] * (x.row(a) - x.row(b) - wanted.transpose());
    slope.row(a) += off;
    slope.row(b) -= off;
  }
  EXPECT_LT(slope.cwiseAbs().maxCoeff(), 1e-9);
  for (const Component& c : s.shape.components) {
    EXPECT_LT((Centroid(s.shape, c, x) - Centroid(s.shape, c, s.shape.positions)).norm(), 1e-9);
  }
}

TEST(PoissonSystem, TakesAnotherReference) {
  System s;
  Make(TubeMesh(6, 8), {2}, s);
  PoissonSystem poisson(s.shape.edges, s.shape.components, s.shape.masses);
  ASSERT_TRUE(poisson.SetReference(s.shape.positions, s.shape.weights));
  const PositionMatrix bent = ToMatrix(BentTube(TubeMesh(6, 8), 1));
  ASSERT_TRUE(poisson.SetReference(bent, CotangentWeights(bent, s.shape.triangles, s.shape.edges)));
  const Eigen::Matrix3d r = AxisAngle({1, 0, 0}, 1);
  const Eigen::RowVector3d centre = Centroid(s.shape, s.shape.components[0], bent);
  const PositionMatrix x = poisson.Solve(DeformationGradients(s.shape.vertices(), r));
  EXPECT_LT((x - Moved(bent.rowwise() - centre, r, centre.transpose())).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(PoissonSystem, OfAMeshWithoutAreaIsSolvable) {
  Mesh line = TubeMesh(5, 6);
  for (Vec3f& p : line.positions) p = {0, 0, p[2]};
  System s;
  Make(line, {2}, s);
  PoissonSystem poisson(s.shape.edges, s.shape.components, s.shape.masses);
  ASSERT_TRUE(poisson.SetReference(s.shape.positions, s.shape.weights));
  const DeformationGradients twice(s.shape.vertices(), 2 * Eigen::Matrix3d::Identity());
  const PositionMatrix x = poisson.Solve(twice);
  EXPECT_NEAR(x.col(2).maxCoeff() - x.col(2).minCoeff(), 2 * 2.0, 1e-6);
}

}  // namespace
}  // namespace sac

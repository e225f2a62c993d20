// SPDX-License-Identifier: Apache-2.0
#include "codec/blend_system.h"

#include <gtest/gtest.h>

#include "tests/test_meshes.h"

namespace sac {
namespace {

// A shape of which every vertex is a handle with `samples` 0, and few are otherwise.
struct System {
  System(const Mesh& mesh, const std::vector<std::uint32_t>& counts, std::uint32_t samples) {
    MakeShape(mesh, counts, samples, 16, header, shape);
  }

  PositionMatrix Positions(RowMatrix z) const {
    PositionMatrix x;
    shape.blend.MoveToOrigin(z);
    shape.blend.Apply(z, x);
    return x;
  }
  PositionMatrix Solve(const BlendSystem& system, const DeformationGradients& gradients) const {
    RowMatrix z;
    BlendSystem::Scratch scratch;
    system.Solve(gradients, scratch, z);
    return Positions(z);
  }
  PositionMatrix Solve(const DeformationGradients& gradients) const { return Solve(*shape.system, gradients); }

  std::size_t handles() const { return shape.blend.handles().vertices.size(); }
  std::vector<double> weights() const {
    return Product(CotangentWeights(shape.positions, shape.triangles, shape.edges), shape.unevenness);
  }

  SequenceHeader header;
  Shape shape;
};

const std::vector<std::uint32_t> kFew = {4, 3, 2, 1};  // of PartsMesh(): 8, 6, 4 and 1 handles

Eigen::RowVector3d Centroid(const Shape& shape, const Component& c, const PositionMatrix& p) {
  const auto mass = shape.masses.segment(c.first, c.count);
  return mass.transpose() * p.middleRows(c.first, c.count) / mass.sum();
}

DeformationGradients RandomGradients(std::size_t count) {
  std::mt19937 random(1);
  DeformationGradients gradients(count);
  for (Eigen::Matrix3d& j : gradients) {
    j = AxisAngle(RandomVector(random), Signed(random)) + 0.2 * RandomVector(random) * RandomVector(random).transpose();
  }
  return gradients;
}

// The sum that the solution minimizes (spec.md 6.5.3), for the coefficients `z`, with `r` of each component.
double Energy(const System& s, const DeformationGradients& gradients, const RowMatrix& z,
              const std::vector<double>& r) {
  const Shape& shape = s.shape;
  const Handles& handles = shape.blend.handles();
  const PositionMatrix x = s.Positions(z);
  const std::vector<double> weights = s.weights();
  double sum = 0;
  for (std::size_t e = 0; e < weights.size(); ++e) {
    Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
    for (const std::uint32_t v : shape.edges.ends[e]) {
      for (std::size_t i = 0; i < handles.FollowedBy(v).size(); ++i) {
        mean += handles.WeightsOf(v)[i] / 2 * gradients[handles.FollowedBy(v)[i]];
      }
    }
    const auto [a, b] = shape.edges.ends[e];
    const Eigen::Vector3d y = shape.positions.row(a) - shape.positions.row(b);
    sum += weights[e] * ((x.row(a) - x.row(b)).transpose() - mean * y).squaredNorm();
  }
  for (std::size_t c = 0; c < shape.components.size(); ++c) {
    if (!shape.blend.IsAffine(c)) continue;
    const Component& run = handles.components[c];
    for (std::uint32_t h = run.first; h < run.first + run.count; ++h) {
      const Eigen::Index t = shape.blend.Translation(c, h);
      sum += r[c] * (z.middleRows(t - 3, 3).transpose() - gradients[h]).squaredNorm();
    }
  }
  return sum;
}

TEST(BlendSystem, ReproducesTheReference) {
  for (const std::uint32_t samples : {0u, 2u}) {
    const System s(PartsMesh(), kFew, samples);
    EXPECT_EQ(s.handles() < s.shape.vertices(), samples > 0);
    const DeformationGradients still(s.handles(), Eigen::Matrix3d::Identity());
    EXPECT_LT((s.Solve(still) - s.shape.positions).cwiseAbs().maxCoeff(), 1e-10);
    RowMatrix rest;
    s.shape.system->Rest(rest);
    EXPECT_LT((s.Positions(rest) - s.shape.positions).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(BlendSystem, TurnsEachComponentAboutItsCentroid) {
  // Linear maps of their own: a rotation, a stretch, and anything.
  Eigen::Matrix3d any;
  any << 1, 2, 3, 0, -1, 4, 2, 0, 1;
  const Eigen::Matrix3d maps[] = {AxisAngle({1, 2, 3}, 2.5), 3 * Eigen::Matrix3d::Identity(), any, any};
  for (const std::uint32_t samples : {0u, 2u}) {
    const System s(PartsMesh(), kFew, samples);
    DeformationGradients gradients(s.handles());
    PositionMatrix expected(s.shape.positions.rows(), 3);
    for (std::size_t i = 0; i < s.shape.components.size(); ++i) {
      const Component &c = s.shape.components[i], &run = s.shape.blend.handles().components[i];
      std::fill_n(gradients.begin() + run.first, run.count, maps[i]);
      const Eigen::RowVector3d centre = Centroid(s.shape, c, s.shape.positions);
      expected.middleRows(c.first, c.count) =
          Moved(s.shape.positions.middleRows(c.first, c.count).rowwise() - centre, maps[i], centre.transpose());
    }
    EXPECT_LT((s.Solve(gradients) - expected).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(BlendSystem, FindsTheMinimum) {
  for (const std::uint32_t samples : {0u, 2u}) {
    const System s(PartsMesh(), kFew, samples);
    const DeformationGradients gradients = RandomGradients(s.handles());
    RowMatrix z;
    BlendSystem::Scratch scratch;
    s.shape.system->Solve(gradients, scratch, z);
    // r: a thousandth of the mean of the diagonal of S, of which it is a part.
    std::vector<double> r;
    for (std::size_t c = 0; c < s.shape.components.size(); ++c) {
      const Eigen::VectorXd diagonal = s.shape.system->Stiffness(c).diagonal();
      double sum = 0;
      for (Eigen::Index i = 0; i < diagonal.size(); ++i) sum += i % 4 < 3 ? diagonal[i] : 0;
      r.push_back(sum / (0.75 * static_cast<double>(diagonal.size())) / 1001);
    }
    const double least = Energy(s, gradients, z, r);
    std::mt19937 random(2);
    for (int trial = 0; trial < 20; ++trial) {
      const RowMatrix step = RowMatrix::NullaryExpr(z.rows(), 3, [&] { return 1e-3 * Signed(random); });
      // At a minimum both ways lead up, and by the same.
      const double up = Energy(s, gradients, z + step, r) - least, down = Energy(s, gradients, z - step, r) - least;
      EXPECT_GT(up, 0);
      EXPECT_NEAR(up, down, 1e-6 * (up + down));
    }
    const PositionMatrix x = s.Positions(z);
    for (const Component& c : s.shape.components) {
      EXPECT_LT((Centroid(s.shape, c, x) - Centroid(s.shape, c, s.shape.positions)).norm(), 1e-9);
    }
  }
}

TEST(BlendSystem, TakesAnotherReference) {
  const System s(TubeMesh(6, 8), {2}, 0);
  const PositionMatrix bent = ToMatrix(BentTube(TubeMesh(6, 8), 1));
  BlendSystem system;
  system.SetReference(s.shape.blend, s.shape.graph, CotangentWeights(bent, s.shape.triangles, s.shape.edges),
                      s.shape.masses, bent);
  ASSERT_TRUE(system.Analyze() && system.Factorize());
  const Eigen::Matrix3d r = AxisAngle({1, 0, 0}, 1);
  const Eigen::RowVector3d centre = Centroid(s.shape, s.shape.components[0], bent);
  const PositionMatrix x = s.Solve(system, DeformationGradients(s.handles(), r));
  EXPECT_LT((x - Moved(bent.rowwise() - centre, r, centre.transpose())).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(BlendSystem, OfAMeshWithoutAreaIsSolvable) {
  Mesh line = TubeMesh(5, 6);
  for (Vec3f& p : line.positions) p = {0, 0, p[2]};
  for (const std::uint32_t samples : {0u, 2u}) {
    const System s(line, {2}, samples);
    const PositionMatrix x = s.Solve(DeformationGradients(s.handles(), 2 * Eigen::Matrix3d::Identity()));
    EXPECT_NEAR(x.col(2).maxCoeff() - x.col(2).minCoeff(), 2 * 2.0, 1e-6);
  }
}

TEST(BlendSystem, OfAPlaneAndOfAPointIsFinite) {
  Mesh plane = TubeMesh(6, 40), point = plane;
  for (Vec3f& p : plane.positions) p[0] = 0;
  for (Vec3f& p : point.positions) p = {1, 1, 1};
  for (const Mesh& mesh : {plane, point}) {
    const System s(mesh, {10}, 2);
    EXPECT_LT(s.handles(), s.shape.vertices());
    EXPECT_TRUE(s.Solve(RandomGradients(s.handles())).allFinite());
  }
}

}  // namespace
}  // namespace sac

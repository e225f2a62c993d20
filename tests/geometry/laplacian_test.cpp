// SPDX-License-Identifier: Apache-2.0
#include "geometry/laplacian.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/test_meshes.h"

namespace sac {
namespace {

using Edge = std::array<std::uint32_t, 2>;

std::map<Edge, double> Weights(const PositionMatrix& positions, const std::vector<Triangle>& triangles) {
  const EdgeList edges = BuildEdges(triangles);
  const auto weights = CotangentWeights(positions, triangles, edges);
  std::map<Edge, double> map;
  for (std::size_t e = 0; e < weights.size(); ++e) map[edges.ends[e]] = weights[e];
  return map;
}

PositionMatrix Rows(std::initializer_list<Eigen::RowVector3d> rows) {
  PositionMatrix p(static_cast<Eigen::Index>(rows.size()), 3);
  Eigen::Index i = 0;
  for (const auto& row : rows) p.row(i++) = row;
  return p;
}

PositionMatrix Tetrahedron() { return Rows({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}); }
const std::vector<Triangle> kTetrahedron = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};

TEST(Edges, AreListedOnceAndSorted) {
  const std::vector<Triangle> triangles = {{2, 1, 0}, {1, 2, 3}, {1, 2, 3}, {4, 4, 0}, {5, 5, 5}};
  const EdgeList edges = BuildEdges(triangles);
  EXPECT_EQ(edges.ends, (std::vector<Edge>{{0, 1}, {0, 2}, {0, 4}, {1, 2}, {1, 3}, {2, 3}}));
  ASSERT_EQ(edges.of_triangle.size(), triangles.size());
  for (std::size_t j = 0; j < triangles.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangles[j][(k + 1) % 3], triangles[j][(k + 2) % 3]);
      const std::uint32_t e = edges.of_triangle[j][k];
      if (a == b) {
        EXPECT_EQ(e, EdgeList::kNone);
      } else {
        ASSERT_LT(e, edges.ends.size());
        EXPECT_EQ(edges.ends[e], (Edge{a, b}));
      }
    }
  }
}

TEST(Edges, OfARunOfVertices) {
  const EdgeList edges = BuildEdges(std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}, {3, 5, 6}});
  const EdgeRange none = EdgesOf(edges, 7, 3), first = EdgesOf(edges, 0, 3), second = EdgesOf(edges, 3, 4);
  EXPECT_EQ(none.count, 0u);
  EXPECT_EQ(first.begin, 0u);
  EXPECT_EQ(first.count, 3u);
  EXPECT_EQ(second.begin, 3u);
  EXPECT_EQ(second.count, 5u);
}

TEST(CotangentWeights, OfARightTriangle) {
  const auto w = Weights(Rows({{0, 0, 7}, {3, 0, 7}, {0, 3, 7}}), {{0, 1, 2}});
  EXPECT_NEAR(w.at({0, 1}), 0.5, 1e-12);  // opposite 45 degrees
  EXPECT_NEAR(w.at({0, 2}), 0.5, 1e-12);
  EXPECT_EQ(w.at({1, 2}), kMinWeight);  // opposite 90 degrees: zero, clamped
}

TEST(CotangentWeights, OfARegularTetrahedron) {
  const auto w = Weights(Tetrahedron(), kTetrahedron);
  ASSERT_EQ(w.size(), 6u);
  for (const auto& [edge, weight] : w) EXPECT_NEAR(weight, 1 / std::sqrt(3.0), 1e-12);
}

TEST(CotangentWeights, AddUpOverTriangles) {
  // A rectangle 1 x 2 cut along its diagonal: two right angles face the diagonal.
  const auto w = Weights(Rows({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}), {{0, 1, 2}, {0, 2, 3}, {0, 2, 3}});
  EXPECT_NEAR(w.at({0, 1}), 0.25, 1e-12);  // cot = 1 / 2
  EXPECT_NEAR(w.at({1, 2}), 1.0, 1e-12);   // cot = 2
  EXPECT_NEAR(w.at({0, 3}), 2.0, 1e-12);   // cot = 2, twice
  EXPECT_EQ(w.at({0, 2}), kMinWeight);
}

TEST(CotangentWeights, DoNotDependOnSizeOrPlace) {
  const Mesh mesh = SphereMesh(3);
  const PositionMatrix p = ToMatrix(mesh.positions);
  const auto w = Weights(p, mesh.triangles);
  for (const double scale : {1e-30, 1e-3, 1e30}) {
    const auto scaled = Weights((scale * p).rowwise() + Eigen::RowVector3d(3, -2, 1) * scale, mesh.triangles);
    for (const auto& [edge, weight] : w) EXPECT_NEAR(scaled.at(edge), weight, 1e-9);
  }
}

TEST(CotangentWeights, AreBoundedForDegenerateTriangles) {
  // A needle, three points on a line, two equal points, all equal, a loop.
  const PositionMatrix p =
      Rows({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0}, {0.5, 0, 0}, {1, 0, 0}, {9, 9, 9}, {9, 9, 9}, {9, 9, 9}});
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {5, 6, 7}, {0, 0, 5}};
  for (const auto& [edge, weight] : Weights(p, triangles)) {
    EXPECT_GE(weight, kMinWeight);
    EXPECT_LE(weight, 2.5 * 3);
  }
}

TEST(VertexMasses, ShareTheArea) {
  const Eigen::VectorXd equal = VertexMasses(Tetrahedron(), kTetrahedron);
  for (const double m : equal) EXPECT_NEAR(m, 0.25, 1e-12);
  // Areas 2 and 6 that share an edge.
  const Eigen::VectorXd m =
      VertexMasses(Rows({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, -6, 0}}), std::vector<Triangle>{{0, 1, 2}, {0, 3, 1}});
  EXPECT_NEAR(m[0], 8.0 / 24, 1e-12);
  EXPECT_NEAR(m[2], 2.0 / 24, 1e-12);
  EXPECT_NEAR(m[3], 6.0 / 24, 1e-12);
}

TEST(VertexMasses, ArePositiveAndSumToOne) {
  const Mesh parts = PartsMesh();
  const Eigen::VectorXd m = VertexMasses(ToMatrix(parts.positions), parts.triangles);
  EXPECT_NEAR(m.sum(), 1, 1e-12);
  EXPECT_GT(m.minCoeff(), 0.9e-3 / static_cast<double>(m.size()));
  EXPECT_EQ(m.minCoeff(), m[m.size() - 1]);  // the vertex alone
  const Eigen::VectorXd flat = VertexMasses(PositionMatrix::Zero(5, 3), std::vector<Triangle>{{0, 1, 2}});
  for (const double x : flat) EXPECT_NEAR(x, 0.2, 1e-12);
}

TEST(LaplacianMatrix, HasZeroRowSumsAndTheWeights) {
  const Mesh mesh = SphereMesh(2);
  const EdgeList edges = BuildEdges(mesh.triangles);
  const auto weights = CotangentWeights(ToMatrix(mesh.positions), mesh.triangles, edges);
  const auto n = static_cast<std::uint32_t>(mesh.positions.size());
  const Eigen::SparseMatrix<double> lower = LaplacianMatrix(edges.ends, weights, 0, n);
  const Eigen::MatrixXd stored = lower;
  EXPECT_TRUE(stored.isLowerTriangular());
  const Eigen::MatrixXd full = stored.selfadjointView<Eigen::Lower>();
  EXPECT_LT(full.rowwise().sum().cwiseAbs().maxCoeff(), 1e-12);
  for (std::size_t e = 0; e < weights.size(); ++e) {
    EXPECT_EQ(full(edges.ends[e][0], edges.ends[e][1]), -weights[e]);
  }
  EXPECT_EQ(static_cast<std::size_t>(lower.nonZeros()), weights.size() + n);
}

TEST(LaplacianMatrix, OfOneComponent) {
  const std::vector<Edge> ends = {{10, 11}, {11, 12}};
  const Eigen::MatrixXd m = LaplacianMatrix(ends, std::vector<double>{2, 3}, 10, 4);
  EXPECT_EQ(m.diagonal(), Eigen::Vector4d(2, 5, 3, 0));
  EXPECT_EQ(m(1, 0), -2);
  EXPECT_EQ(m(2, 1), -3);
}

}  // namespace
}  // namespace sac

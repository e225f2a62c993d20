// SPDX-License-Identifier: Apache-2.0
#include "codec/harmonics.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <numeric>

#include "tests/test_meshes.h"

namespace sac {
namespace {

struct Basis {
  Shape shape;
  std::vector<GridPosition> grid;

  // The harmonics of a component at its vertices.
  Eigen::MatrixXd vectors(std::size_t c = 0) const {
    const ComponentHarmonics& h = shape.basis.components[c];
    Eigen::MatrixXd out(h.component.count, h.vectors.cols());
    PositionMatrix values;
    for (Eigen::Index k = 0; k < out.cols(); ++k) {
      RowMatrix z = RowMatrix::Zero(shape.blend.columns(), 3);
      z.block(h.functions.first, 0, h.functions.count, 1) = h.vectors.col(k);
      shape.blend.MoveToOrigin(z);
      shape.blend.Apply(z, values);
      out.col(k) = values.block(h.component.first, 0, h.component.count, 1);
    }
    return out;
  }
  const Eigen::VectorXd& values(std::size_t c = 0) const { return shape.basis.components[c].eigenvalues; }
};

Basis Compute(const Mesh& mesh, const std::vector<std::uint32_t>& counts, std::uint32_t samples = 0) {
  Basis basis;
  SequenceHeader header;
  MakeShape(mesh, counts, samples, 12, header, basis.shape);
  const Eigen::RowVector3d origin(header.origin_x, header.origin_y, header.origin_z);
  for (Eigen::Index v = 0; v < basis.shape.positions.rows(); ++v) {
    const Eigen::RowVector3d g = (basis.shape.positions.row(v) - origin) / static_cast<double>(header.cell);
    basis.grid.push_back({static_cast<std::uint32_t>(std::lround(g[0])), static_cast<std::uint32_t>(std::lround(g[1])),
                          static_cast<std::uint32_t>(std::lround(g[2]))});
  }
  return basis;
}

// The operator of the definition, written down once more: cotangent weights times 1 + 0.1 g at the edge's middle, g a
// cubic of the coordinates scaled to the component's box.
Eigen::MatrixXd UnevenLaplacian(const Basis& basis, const Component& c) {
  const auto point = [&](std::uint32_t v) {
    return Eigen::Vector3d(basis.grid[v][0], basis.grid[v][1], basis.grid[v][2]);
  };
  Eigen::Vector3d low = point(c.first), high = low;
  for (std::uint32_t v = c.first; v < c.first + c.count; ++v) {
    low = low.cwiseMin(point(v));
    high = high.cwiseMax(point(v));
  }
  const double extent = std::max(1.0, (high - low).maxCoeff());
  const std::vector<double> weights = CotangentWeights(basis.shape.positions, basis.shape.triangles, basis.shape.edges);
  Eigen::MatrixXd l = Eigen::MatrixXd::Zero(c.count, c.count);
  for (std::size_t e = 0; e < basis.shape.edges.ends.size(); ++e) {
    const auto [a, b] = basis.shape.edges.ends[e];
    if (a < c.first || a >= c.first + c.count) continue;
    const Eigen::Vector3d m = ((point(a) + point(b)) / 2 - low) / extent;
    const double x = m[0], y = m[1], z = m[2];
    const double linear = 0.31 * x - 0.23 * y + 0.17 * z;
    const double quadratic = 0.19 * x * y - 0.29 * y * z + 0.13 * x * z + 0.21 * x * x - 0.15 * z * z;
    const double cubic = 0.11 * x * x * y - 0.07 * y * y * z + 0.05 * z * z * x + 0.09 * y * y * y;
    const double w = weights[e] * (1 + 0.1 * (linear + quadratic + cubic));
    const Eigen::Index i = a - c.first, j = b - c.first;
    l(i, i) += w;
    l(j, j) += w;
    l(i, j) -= w;
    l(j, i) -= w;
  }
  return l;
}

void ExpectScaledAndOrthogonal(const Basis& basis, double tolerance) {
  for (std::size_t i = 0; i < basis.shape.components.size(); ++i) {
    const ComponentHarmonics& c = basis.shape.basis.components[i];
    const Eigen::MatrixXd vectors = basis.vectors(i);
    const Eigen::VectorXd mass = basis.shape.masses.segment(c.component.first, c.component.count);
    const Eigen::MatrixXd gram = vectors.transpose() * mass.asDiagonal() * vectors / mass.sum();
    EXPECT_LT((gram - Eigen::MatrixXd::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff(), tolerance);
    EXPECT_EQ(c.eigenvalues[0], 0);
    EXPECT_LT((vectors.col(0).array() - 1).abs().maxCoeff(), 1e-12);
    for (Eigen::Index k = 1; k < c.eigenvalues.size(); ++k) EXPECT_GE(c.eigenvalues[k], c.eigenvalues[k - 1]);
    if (c.eigenvalues.size() > 1) {
      EXPECT_GT(c.eigenvalues[1], 0);
    }
  }
}

void ExpectEigenpairs(const Basis& basis) {
  for (const ComponentHarmonics& c : basis.shape.basis.components) {
    const Eigen::VectorXd mass = basis.shape.masses.segment(c.component.first, c.component.count);
    const Eigen::MatrixXd l = UnevenLaplacian(basis, c.component);
    for (Eigen::Index k = 0; k < c.vectors.cols(); ++k) {
      const Eigen::VectorXd image = l * c.vectors.col(k);
      const Eigen::VectorXd scaled = c.eigenvalues[k] * mass.cwiseProduct(c.vectors.col(k));
      EXPECT_LT((image - scaled).norm(), 1e-8 * (1 + c.eigenvalues[k]) * mass.norm()) << k;
    }
  }
}

TEST(Harmonics, AreEigenfunctionsOfALargeMesh) {
  const Basis basis = Compute(SphereMesh(7), {60});  // 492 vertices: by shift and invert
  ExpectEigenpairs(basis);
  ExpectScaledAndOrthogonal(basis, 1e-9);
}

TEST(Harmonics, AreEigenfunctionsOfEachPart) {
  const Basis basis = Compute(PartsMesh(), {30, 20, 4, 1});
  ExpectEigenpairs(basis);
  ExpectScaledAndOrthogonal(basis, 1e-9);
}

TEST(Harmonics, MayBeAsManyAsVertices) {
  const Basis basis = Compute(TubeMesh(5, 6), {30});
  ExpectEigenpairs(basis);
  ExpectScaledAndOrthogonal(basis, 1e-9);
}

TEST(Harmonics, OfASphereAreItsSpectrum) {
  const Basis basis = Compute(SphereMesh(8), {36});
  // 2 k + 1 functions of eigenvalue k (k + 1) on the unit sphere, times 4 pi, since masses sum to 1. Uneven weights may
  // shift each by 10 %, and the mesh by a few.
  for (int k = 1; k < 6; ++k) {
    const double expected = 4 * std::numbers::pi * k * (k + 1);
    for (int i = k * k; i < (k + 1) * (k + 1); ++i) EXPECT_NEAR(basis.values()[i], expected, 0.13 * expected) << i;
  }
}

TEST(Harmonics, DoNotDependOnTheNumberingOfVertices) {
  for (const std::uint32_t frequency : {2u, 5u}) {  // dense, sparse
    const Mesh mesh = SphereMesh(frequency);
    std::vector<std::uint32_t> to(mesh.positions.size());
    std::iota(to.begin(), to.end(), 0u);
    std::mt19937 random(1);
    std::shuffle(to.begin(), to.end(), random);
    Mesh shuffled = mesh;
    for (std::size_t v = 0; v < to.size(); ++v) shuffled.positions[to[v]] = mesh.positions[v];
    for (Triangle& t : shuffled.triangles) t = {to[t[1]], to[t[2]], to[t[0]]};
    std::reverse(shuffled.triangles.begin(), shuffled.triangles.end());
    const Basis a = Compute(mesh, {30}), b = Compute(shuffled, {30});
    for (Eigen::Index k = 0; k < 30; ++k) {
      EXPECT_NEAR(a.values()[k], b.values()[k], 1e-8 * (1 + a.values()[k]));
      Eigen::VectorXd back(a.vectors().rows());
      for (std::size_t v = 0; v < to.size(); ++v) back[static_cast<Eigen::Index>(v)] = b.vectors()(to[v], k);
      const Eigen::VectorXd same = a.vectors().col(k);
      EXPECT_LT(std::min((same - back).norm(), (same + back).norm()), 1e-6 * same.norm()) << k;  // signs are by index
    }
  }
}

// The largest sine of an angle between one of the first `low` columns of `of` and the span of `in`.
double Gap(const Eigen::MatrixXd& of, const Eigen::MatrixXd& in, Eigen::Index low, const Eigen::VectorXd& mass) {
  const Eigen::MatrixXd left = of.leftCols(low) - in * (in.transpose() * mass.asDiagonal() * of.leftCols(low));
  const Eigen::MatrixXd weighted = mass.cwiseSqrt().asDiagonal() * left;
  return Eigen::JacobiSVD<Eigen::MatrixXd>(weighted).singularValues()[0];
}

TEST(Harmonics, OfABlendSpanNearlyTheSame) {
  for (const Mesh& mesh : {SphereMesh(8), TubeMesh(40, 16)}) {
    const Basis exact = Compute(mesh, {50});
    const Eigen::VectorXd& mass = exact.shape.masses;
    for (const std::uint32_t samples : {2u, 3u}) {
      const Basis blend = Compute(mesh, {50}, samples);
      EXPECT_TRUE(blend.shape.blend.IsAffine(0));
      ExpectScaledAndOrthogonal(blend, 1e-9);
      EXPECT_LT(Gap(exact.vectors(), blend.vectors(), 25, mass), 0.1);
      for (Eigen::Index k = 1; k < 50; ++k) {  // Rayleigh and Ritz: never below
        EXPECT_GE(blend.values()[k], exact.values()[k] * (1 - 1e-9)) << k;
        if (k < 25) {
          EXPECT_LT(blend.values()[k], exact.values()[k] * 1.02) << k;
        }
      }
      // What the deformation gradients are evaluated with.
      const Handles& handles = blend.shape.blend.handles();
      const Eigen::MatrixXd vectors = blend.vectors();
      for (std::size_t h = 0; h < handles.vertices.size(); ++h) {
        const double off =
            (blend.shape.AtHandles(0).row(static_cast<Eigen::Index>(h)) - vectors.row(handles.vertices[h]))
                .cwiseAbs()
                .maxCoeff();
        EXPECT_LT(off, 1e-12);
      }
    }
  }
}

TEST(Harmonics, AreExactWhereEveryVertexIsAHandle) {
  const Mesh mesh = SphereMesh(3);  // 92 vertices
  const Basis exact = Compute(mesh, {30}), sampled = Compute(mesh, {30}, 4);
  EXPECT_EQ(exact.vectors(), sampled.vectors());
}

TEST(Harmonics, OfMeshesWithoutExtentAreFinite) {
  Mesh flat = TubeMesh(12, 10);
  for (Vec3f& p : flat.positions) p = {0, 0, p[2]};  // a line
  flat.positions.push_back({0, 0, 0});
  for (const std::uint32_t samples : {0u, 1u, 2u}) {
    const Basis basis = Compute(flat, {20, 1}, samples);
    for (std::size_t c = 0; c < 2; ++c) {
      EXPECT_TRUE(basis.vectors(c).allFinite());
      EXPECT_TRUE(basis.values(c).allFinite());
    }
    ExpectScaledAndOrthogonal(basis, 1e-6);
  }
}

TEST(Fingerprint, TellsBasesApart) {
  const auto of = [](const Basis& basis) { return Fingerprint(basis.shape.basis, {}); };
  const Basis sphere = Compute(SphereMesh(4), {20});
  EXPECT_TRUE(SameFingerprint(of(sphere), of(Compute(SphereMesh(4), {20}))));
  EXPECT_FALSE(SameFingerprint(of(sphere), of(Compute(SphereMesh(4), {19}))));
  EXPECT_FALSE(SameFingerprint(of(sphere), of(Compute(SphereMesh(4), {20}, 2))));
  Basis turned = Compute(SphereMesh(4), {20});
  turned.shape.basis.components[0].vectors.col(7) *= -1;
  EXPECT_FALSE(SameFingerprint(of(sphere), of(turned)));
}

TEST(Fingerprint, CoversPatches) {
  const HarmonicBasis sphere = Compute(SphereMesh(4), {20}).shape.basis;
  HarmonicBasis patches = Compute(SphereMesh(3), {92}).shape.basis;
  const auto good = Fingerprint(sphere, patches);
  EXPECT_FALSE(SameFingerprint(good, Fingerprint(sphere, {})));
  patches.components[0].vectors.col(91) *= -1;
  EXPECT_FALSE(SameFingerprint(good, Fingerprint(sphere, patches)));
}

TEST(Fingerprint, IsOneOfManyPoints) {  // however many constants there are
  HarmonicBasis points;
  for (std::uint32_t i = 0; i < 100000; ++i) {
    points.components.push_back(
        {{i, 1}, {i, 1}, Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)});
  }
  EXPECT_EQ(Fingerprint(points, points), (std::array<float, 2>{0, 0}));
}

}  // namespace
}  // namespace sac

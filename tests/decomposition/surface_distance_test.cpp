// SPDX-License-Identifier: Apache-2.0
#include "decomposition/surface_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/decomposition/test_fields.h"
#include "tests/test_meshes.h"

namespace sac {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double Angle(const PositionMatrix& p, Eigen::Index a, Eigen::Index b) {
  return std::acos(std::clamp(p.row(a).normalized().dot(p.row(b).normalized()), -1.0, 1.0));
}

TEST(SurfaceDistance, OfAPlane) {
  const Mesh mesh = GridMesh(41);
  const PositionMatrix p = ToMatrix(mesh.positions);
  const SurfaceDistance distance(p, mesh.triangles);
  for (const std::uint32_t from : {0u, 20u * 41 + 20, 7u * 41 + 33}) {
    const SurfaceDistance::Seed seed{from, 0};
    const std::vector<double> d = distance.From({&seed, 1}, kInfinity);
    for (std::size_t v = 0; v < d.size(); ++v) {
      const double exact = (p.row(static_cast<Eigen::Index>(v)) - p.row(from)).norm();
      EXPECT_NEAR(d[v], exact, 0.02 * exact + 1e-12);
    }
  }
}

TEST(SurfaceDistance, OfAPlaneOfSlivers) {
  Mesh mesh = GridMesh(41);
  for (Vec3f& p : mesh.positions) p[0] *= 0.1f;  // triangles ten times as long as wide
  const PositionMatrix p = ToMatrix(mesh.positions);
  const SurfaceDistance distance(p, mesh.triangles);
  const SurfaceDistance::Seed seed{0, 0};
  const std::vector<double> d = distance.From({&seed, 1}, kInfinity);
  double worst = 0;
  for (std::size_t v = 1; v < d.size(); ++v) {
    const double exact = (p.row(static_cast<Eigen::Index>(v)) - p.row(0)).norm();
    EXPECT_GE(d[v], exact * (1 - 1e-6));
    worst = std::max(worst, d[v] / exact - 1);
  }
  EXPECT_LT(worst, 0.05);
}

TEST(SurfaceDistance, OfASphere) {
  const Mesh mesh = SphereMesh(20);
  const PositionMatrix p = ToMatrix(mesh.positions);
  const SurfaceDistance distance(p, mesh.triangles);
  const SurfaceDistance::Seed seed{5, 0};
  const std::vector<double> d = distance.From({&seed, 1}, kInfinity);
  for (std::size_t v = 0; v < d.size(); ++v) {
    const double exact = Angle(p, 5, static_cast<Eigen::Index>(v));
    EXPECT_NEAR(d[v], exact, 0.02 * exact + 1e-12);
  }
}

TEST(SurfaceDistance, EndsAtABoundAndAtBorders) {
  const Mesh mesh = GridMesh(21);
  const PositionMatrix p = ToMatrix(mesh.positions);
  const SurfaceDistance distance(p, mesh.triangles);
  const SurfaceDistance::Seed seed{0, 0};
  const std::vector<double> d = distance.From({&seed, 1}, 0.5);
  for (std::size_t v = 0; v < d.size(); ++v) {
    const double exact = p.row(static_cast<Eigen::Index>(v)).norm();
    EXPECT_TRUE(d[v] == kInfinity ? exact > 0.48 : exact <= 0.5) << exact;
  }
}

TEST(SurfaceDistance, AcrossAGap) {
  Mesh mesh = GridMesh(11);
  AppendMesh(mesh, GridMesh(11), {1.25, 0, 0});
  AppendMesh(mesh, GridMesh(11), {1.25, 1.5, 0});
  mesh.positions.push_back({0, -0.5f, 0});
  const PositionMatrix p = ToMatrix(mesh.positions);
  const SurfaceDistance apart(p, mesh.triangles, false);
  const SurfaceDistance::Seed seed{0, 0};
  const std::vector<double> alone = apart.From({&seed, 1}, kInfinity);
  EXPECT_TRUE(std::isfinite(alone[120]));
  EXPECT_EQ(alone[121], kInfinity);
  EXPECT_EQ(alone[363], kInfinity);
  const SurfaceDistance joined(p, mesh.triangles);
  const std::vector<double> d = joined.From({&seed, 1}, kInfinity);
  for (const double x : d) EXPECT_TRUE(std::isfinite(x));
  EXPECT_NEAR(d[363], 0.5, 1e-6);                         // the vertex alone
  EXPECT_GE(d[131], 2.25 * (1 - 1e-6));                   // the far corner of the second, over the gap
  EXPECT_GE(d[362], std::hypot(2.25, 2.5) * (1 - 1e-6));  // the far corner of the third
}

TEST(SurfaceDistance, AtTriangles) {
  const Mesh mesh = GridMesh(21);
  const PositionMatrix p = ToMatrix(mesh.positions);
  const SurfaceDistance distance(p, mesh.triangles);
  const auto centroid = [&](std::uint32_t j) -> Eigen::RowVector3d {
    const Triangle& t = mesh.triangles[j];
    return (p.row(t[0]) + p.row(t[1]) + p.row(t[2])) / 3;
  };
  const std::uint32_t from = 400;
  const std::vector<double> d = distance.FromTriangles({&from, 1}, kInfinity);
  for (std::uint32_t j = 0; j < d.size(); ++j) {
    EXPECT_NEAR(d[j], (centroid(j) - centroid(from)).norm(), 0.06);  // an edge is 0.05 long
  }
}

}  // namespace
}  // namespace sac

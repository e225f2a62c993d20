// SPDX-License-Identifier: Apache-2.0
#include "rate_control/shape_residual.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/test_meshes.h"

namespace sac {
namespace {

Positions Shifted(Positions positions, const Positions& offsets) {
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) positions[v][a] += 0.01F * offsets[v][a];
  }
  return positions;
}

double LargestDistance(const Positions& a, const Positions& b) {
  return (ToMatrix(a) - ToMatrix(b)).rowwise().norm().maxCoeff();
}

// Takes `frames` rotations of `shape` for the originals of those of `wrong`.
void AddRotations(const Positions& shape, const Positions& wrong, int frames, ShapeResidual& residual) {
  for (int t = 0; t < frames; ++t) {
    const Eigen::Matrix3d turn = AxisAngle({1, 2, -1}, 0.7 * t);
    const Eigen::Vector3d shift(t, 0, -2 * t);
    residual.Add(Moved(shape, turn, shift), Moved(wrong, turn, shift));
  }
}

TEST(ShapeResidual, FindsTheShapeThatRotatedFramesAgreeOn) {
  std::mt19937 random(1);
  const Mesh mesh = SphereMesh(6);
  const Positions wrong = Shifted(mesh.positions, RandomPositions(random, mesh.positions.size()));
  ShapeResidual residual(mesh.triangles, mesh.positions.size(), 1);
  residual.Begin(wrong);
  AddRotations(mesh.positions, wrong, 7, residual);
  EXPECT_EQ(residual.frames(), 7u);
  EXPECT_LT(LargestDistance(residual.Corrected(1, mesh.positions), mesh.positions), 1e-5);
  EXPECT_NEAR(LargestDistance(residual.Corrected(0.5, mesh.positions), mesh.positions),
              LargestDistance(wrong, mesh.positions) / 2, 1e-5);
}

TEST(ShapeResidual, AveragesWhatDiffersFromFrameToFrame) {
  std::mt19937 random(2);
  const Mesh mesh = SphereMesh(4);
  ShapeResidual residual(mesh.triangles, mesh.positions.size(), 1);
  residual.Begin(mesh.positions);
  for (int t = 0; t < 100; ++t) {
    const Positions noisy = Shifted(mesh.positions, RandomPositions(random, mesh.positions.size()));
    residual.Add(noisy, mesh.positions);
  }
  EXPECT_LT(LargestDistance(residual.Corrected(1, mesh.positions), mesh.positions), 0.003);
}

TEST(ShapeResidual, TakesTheRotationOfTheComponentWhereATriangleHasNoArea) {
  Mesh mesh = SphereMesh(3);
  const auto loose = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back({3, 0, 0});  // in a triangle without area
  mesh.positions.push_back({0, 3, 0});  // in no triangle
  mesh.triangles.push_back({0, loose, loose});
  Positions wrong = mesh.positions;
  wrong[loose][1] += 0.5F;
  wrong[loose + 1][2] -= 0.25F;
  ShapeResidual residual(mesh.triangles, mesh.positions.size(), 1);
  residual.Begin(wrong);
  AddRotations(mesh.positions, wrong, 5, residual);
  EXPECT_LT(LargestDistance(residual.Corrected(1, mesh.positions), mesh.positions), 1e-5);
}

TEST(ShapeResidual, KeepsDirectionsWithoutAnyArea) {
  const Positions points{{0, 0, 0}, {1, 0, 0}};
  const Positions there{{0, 0, 2}, {1, 0, 0}};
  ShapeResidual residual({{0, 1, 1}}, 2, 1);
  residual.Begin(points);
  residual.Add(there, points);
  EXPECT_EQ(residual.Corrected(1, points), there);
}

TEST(ShapeResidual, SkipsFramesBetweenAndBeginsAgain) {
  const Mesh mesh = SphereMesh(2);
  ShapeResidual residual(mesh.triangles, mesh.positions.size(), 3);
  residual.Begin(mesh.positions);
  const Positions off = Moved(mesh.positions, Eigen::Matrix3d::Identity(), {1, 0, 0});
  for (int t = 0; t < 7; ++t) residual.Add(t % 3 == 0 ? mesh.positions : off, mesh.positions);
  EXPECT_EQ(residual.frames(), 3u);
  EXPECT_EQ(residual.Corrected(1, mesh.positions), mesh.positions);
  residual.Begin(off);
  residual.Add(off, off);
  EXPECT_EQ(residual.frames(), 1u);
  EXPECT_EQ(residual.Corrected(1, mesh.positions), off);
}

TEST(ShapeResidual, KeepsSeamsClosed) {
  // Two triangles with copies of the edge between them.
  const Positions first{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  Positions original = first;
  original[1][2] = 0.5F;
  original[3][2] = 0.25F;
  ShapeResidual residual({{0, 1, 2}, {3, 5, 4}}, 6, 1);
  residual.Begin(first);
  residual.Add(original, first);
  const Positions corrected = residual.Corrected(1, first);
  EXPECT_EQ(corrected[1], corrected[3]);
  EXPECT_EQ(corrected[2], corrected[4]);
  EXPECT_NEAR(corrected[1][2], 0.375, 1e-6);
}

}  // namespace
}  // namespace sac

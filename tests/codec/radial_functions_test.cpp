// SPDX-License-Identifier: Apache-2.0
#include "codec/radial_functions.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <random>

namespace sac {
namespace {

using Grid = std::vector<GridPosition>;

Grid RandomGrid(std::size_t n, std::uint32_t size, std::uint32_t seed) {
  std::mt19937 random(seed);
  Grid grid(n);
  for (auto& g : grid) {
    for (auto& x : g) x = static_cast<std::uint32_t>(random() % size);
  }
  return grid;
}

Eigen::MatrixXd Functions(const Grid& grid, std::uint32_t samples) {
  Eigen::SparseMatrix<double> functions;
  EXPECT_TRUE(RadialFunctions(grid, samples, 1e9, functions));
  return functions;
}

TEST(RadialFunctions, SumToOneEverywhere) {
  for (const std::uint32_t samples : {1u, 2u, 17u, 150u}) {
    const Grid grid = RandomGrid(500, 1u << 24, samples);
    const Eigen::MatrixXd f = Functions(grid, samples);
    ASSERT_EQ(f.rows(), 500);
    ASSERT_EQ(f.cols(), static_cast<Eigen::Index>(samples));
    EXPECT_GE(f.minCoeff(), 0);
    EXPECT_LT((f.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-12);
  }
}

TEST(RadialFunctions, AreIndependent) {
  const Eigen::MatrixXd f = Functions(RandomGrid(400, 4096, 1), 60);
  EXPECT_EQ(Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(f).rank(), 60);
}

TEST(RadialFunctions, PeakAtFarthestPoints) {
  // A line of points: the first, the last, the middle, and so on.
  Grid grid;
  for (std::uint32_t i = 0; i <= 64; ++i) grid.push_back({i, 5, 5});
  const Eigen::MatrixXd f = Functions(grid, 5);
  const Eigen::Index expected[] = {0, 64, 32, 16, 48};  // of 16 and 48, equally far, the first one first
  for (Eigen::Index i = 0; i < 5; ++i) {
    for (const Eigen::Index j : expected) EXPECT_LE(f(j, i), f(expected[i], i));
  }
  EXPECT_GT(f(0, 0), f(1, 0));
}

TEST(RadialFunctions, AreMissingWhenPositionsRunOut) {
  Grid grid = RandomGrid(40, 2, 1);  // 8 positions at most
  EXPECT_EQ(Functions(grid, 9).cols(), 0);
  EXPECT_EQ(Functions(grid, 8).cols(), 8);
  grid.assign(40, {7, 7, 7});
  EXPECT_EQ(Functions(grid, 2).cols(), 0);
  const Eigen::MatrixXd one = Functions(grid, 1);
  EXPECT_EQ(one, Eigen::MatrixXd::Ones(40, 1));
}

TEST(RadialFunctions, AreCountedBeforeTheyAreStored) {
  const Grid grid = RandomGrid(400, 4096, 1);
  const auto values = static_cast<double>((Functions(grid, 60).array() > 0).count());
  EXPECT_GT(values, 20 * 400);  // a volume
  Eigen::SparseMatrix<double> functions;
  EXPECT_TRUE(RadialFunctions(grid, 60, values, functions));
  EXPECT_FALSE(RadialFunctions(grid, 60, values - 1, functions));
}

}  // namespace
}  // namespace sac

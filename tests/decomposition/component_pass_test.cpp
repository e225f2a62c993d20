// SPDX-License-Identifier: Apache-2.0
#include "decomposition/component_pass.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "tests/test_meshes.h"

namespace sac {
namespace {

// 50 nodes with random values and weights.
struct Problem {
  NodeField field;
  Alternation state;
};

Problem RandomProblem(std::size_t channels) {
  std::mt19937 random(11);
  Problem p;
  p.field.nodes = 50;
  p.field.channels = channels;
  p.field.columns = 12;
  p.field.values.resize(50 * channels * 12);
  for (float& x : p.field.values) x = static_cast<float>(Signed(random));
  p.field.mass.assign(50, 1);
  p.state.count = 4;
  p.state.weights = Eigen::MatrixXd(12, 4);
  for (Eigen::Index i = 0; i < p.state.weights.size(); ++i) p.state.weights.data()[i] = Signed(random);
  p.state.components.assign(50 * channels * 4, 0);
  p.state.cost.resize(50 * 4);
  for (float& x : p.state.cost) x = static_cast<float>(1 + Signed(random));
  p.state.sites.resize(4);
  return p;
}

// The components of one node by proximal gradient descent in double: slow and plain.
Eigen::MatrixXd Dense(const Problem& p, std::size_t node) {
  const Eigen::MatrixXd& w = p.state.weights;
  const Eigen::MatrixXd x = p.field.OfNode(node);  // frames x channels
  const double step = 1 / (w.transpose() * w).operatorNorm();
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(w.cols(), x.cols());
  for (int i = 0; i < 20000; ++i) {
    c -= step * w.transpose() * (w * c - x);
    for (Eigen::Index k = 0; k < c.rows(); ++k) {
      const auto cost = static_cast<double>(p.state.cost[node * 4 + static_cast<std::size_t>(k)]);
      const double length = c.row(k).norm();
      c.row(k) *= length > 0 ? std::max(0.0, 1 - step * cost / length) : 0;
    }
  }
  return c;
}

TEST(ComponentPass, FindsTheMinimumOfADenseSolver) {
  for (const std::size_t channels : {3, 9}) {
    Problem p = RandomProblem(channels);
    PassSums sums;
    for (int i = 0; i < 50; ++i) RunPass(p.field, true, 2, p.state, sums);
    for (std::size_t node = 0; node < 50; ++node) {
      const Eigen::MatrixXd dense = Dense(p, node);
      for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t a = 0; a < channels; ++a) {
          const float found = p.state.components[(node * channels + a) * 4 + k];
          EXPECT_NEAR(found, dense(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(a)), 1e-4);
        }
      }
    }
  }
}

TEST(ComponentPass, SumsAreThoseOfTheMatrices) {
  Problem p = RandomProblem(3);
  for (std::size_t i = 0; i < 50; ++i) p.field.mass[i] = 0.5f + 0.02f * static_cast<float>(i);
  PassSums sums;
  RunPass(p.field, true, 1, p.state, sums);
  Eigen::MatrixXd pp = Eigen::MatrixXd::Zero(12, 4), h = Eigen::MatrixXd::Zero(4, 4);
  Eigen::VectorXd penalty = Eigen::VectorXd::Zero(4);
  double residual = 0;
  for (std::size_t i = 0; i < 50; ++i) {
    Eigen::MatrixXd c(4, 3);
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t a = 0; a < 3; ++a) {
        c(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(a)) = p.state.components[(i * 3 + a) * 4 + k];
      }
      const auto row = static_cast<Eigen::Index>(k);
      penalty[row] += double{p.field.mass[i]} * double{p.state.cost[i * 4 + k]} * c.row(row).norm();
    }
    const double m = p.field.mass[i];
    pp += m * p.field.OfNode(i) * c.transpose();
    h += m * c * c.transpose();
    residual += m * (p.field.OfNode(i) - p.state.weights * c).squaredNorm();
  }
  EXPECT_LT((sums.p - pp).norm(), 1e-5 * pp.norm());
  EXPECT_LT((sums.h - h).norm(), 1e-5 * h.norm());
  EXPECT_LT((sums.penalty - penalty).norm(), 1e-5 * penalty.norm());
  EXPECT_NEAR(ResidualSquare(p.field, p.state, 2), residual, 1e-5 * residual);
}

}  // namespace
}  // namespace sac

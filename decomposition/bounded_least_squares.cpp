// SPDX-License-Identifier: Apache-2.0
#include "decomposition/bounded_least_squares.h"

#include <algorithm>
#include <cmath>

namespace sac {
namespace {

constexpr int kMostSweeps = 500;
constexpr double kTolerance = 1e-9;  // of the largest change in a sweep against the largest value
constexpr double kNothing = 1e-14;   // of the largest diagonal: a variable without influence

bool Settled(double change, double size) { return change <= kTolerance * std::max(size, 1e-30); }

}  // namespace

Eigen::VectorXd BoundedLeastSquares(const Eigen::MatrixXd& h, const Eigen::VectorXd& g, const Eigen::VectorXd& start,
                                    double low, double high) {
  Eigen::VectorXd w = start.cwiseMax(low).cwiseMin(high);
  if (w.size() == 0) return w;
  const double least = kNothing * h.diagonal().maxCoeff();
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double change = 0;
    for (Eigen::Index k = 0; k < w.size(); ++k) {
      if (!(h(k, k) > least)) continue;
      const double next = std::clamp(w[k] + (g[k] - h.col(k).dot(w)) / h(k, k), low, high);
      change = std::max(change, std::abs(next - w[k]));
      w[k] = next;
    }
    if (Settled(change, w.cwiseAbs().maxCoeff())) break;
  }
  return w;
}

Eigen::VectorXd SparseLeastSquares(const Eigen::MatrixXd& h, const Eigen::VectorXd& g, const Eigen::VectorXd& price,
                                   const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
  Eigen::VectorXd w = Eigen::VectorXd::Zero(g.size());
  if (w.size() == 0) return w;
  const double least = kNothing * h.diagonal().maxCoeff();
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double change = 0;
    for (Eigen::Index k = 0; k < w.size(); ++k) {
      if (!(h(k, k) > least)) continue;
      const double t = g[k] - h.col(k).dot(w) + h(k, k) * w[k];
      const double shrunk = std::copysign(std::max(std::abs(t) - price[k], 0.0), t) / h(k, k);
      const double next = std::clamp(shrunk, low[k], high[k]);
      change = std::max(change, std::abs(next - w[k]));
      w[k] = next;
    }
    if (Settled(change, w.cwiseAbs().maxCoeff())) break;
  }
  return w;
}

}  // namespace sac

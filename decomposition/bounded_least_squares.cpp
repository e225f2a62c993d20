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

// Coordinate descent from `w`: `minimum(k, h.col(k).dot(w))` is the value of variable k that is best with the others as
// they are.
template <class Minimum>
void Descend(const Eigen::MatrixXd& h, Eigen::VectorXd& w, const Minimum& minimum) {
  if (w.size() == 0) return;
  const double least = kNothing * h.diagonal().maxCoeff();
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double change = 0;
    for (Eigen::Index k = 0; k < w.size(); ++k) {
      if (!(h(k, k) > least)) continue;
      const double next = minimum(k, h.col(k).dot(w));
      change = std::max(change, std::abs(next - w[k]));
      w[k] = next;
    }
    if (Settled(change, w.cwiseAbs().maxCoeff())) break;
  }
}

}  // namespace

Eigen::VectorXd BoundedLeastSquares(const Eigen::MatrixXd& h, const Eigen::VectorXd& g, const Eigen::VectorXd& start,
                                    double low, double high) {
  Eigen::VectorXd w = start.cwiseMax(low).cwiseMin(high);
  Descend(h, w, [&](Eigen::Index k, double sum) { return std::clamp(w[k] + (g[k] - sum) / h(k, k), low, high); });
  return w;
}

Eigen::VectorXd SparseLeastSquares(const Eigen::MatrixXd& h, const Eigen::VectorXd& g, const Eigen::VectorXd& price,
                                   const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
  Eigen::VectorXd w = Eigen::VectorXd::Zero(g.size());
  Descend(h, w, [&](Eigen::Index k, double sum) {
    const double t = g[k] - sum + h(k, k) * w[k];
    const double shrunk = std::copysign(std::max(std::abs(t) - price[k], 0.0), t) / h(k, k);
    return std::clamp(shrunk, low[k], high[k]);
  });
  return w;
}

}  // namespace sac

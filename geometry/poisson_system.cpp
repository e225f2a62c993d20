// SPDX-License-Identifier: Apache-2.0
#include "geometry/poisson_system.h"

#include <algorithm>
#include <utility>

namespace sac {

PoissonSystem::PoissonSystem(const EdgeList& edges, std::span<const Component> components,
                             const Eigen::VectorXd& masses)
    : edges_(edges), components_(components), masses_(masses) {}

bool PoissonSystem::SetReference(const PositionMatrix& reference, std::vector<double> weights) {
  reference_ = reference;
  weights_ = std::move(weights);
  matrix_ = LaplacianMatrix(edges_.ends, weights_, 0, static_cast<std::uint32_t>(masses_.size()));
  // Every component is free to move as a whole: tie its first vertex to the origin, Solve() moves it afterwards.
  const double tie = std::max(matrix_.diagonal().mean(), 1.0);
  for (const Component& c : components_) matrix_.coeffRef(c.first, c.first) += tie;
  if (!analyzed_) analyzed_ = solver_.Analyze(matrix_);
  if (!analyzed_) return false;
  return solver_.Factorize(matrix_);
}

const PositionMatrix& PoissonSystem::Solve(const DeformationGradients& gradients) {
  right_side_.setZero(reference_.rows(), 3);
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const auto [a, b] = edges_.ends[i];
    const Eigen::Vector3d edge = reference_.row(a) - reference_.row(b);
    const Eigen::Vector3d pull = (gradients[a] + gradients[b]) * edge * (weights_[i] / 2);
    right_side_.row(a) += pull;
    right_side_.row(b) -= pull;
  }
  columns_ = right_side_;
  solver_.SolveInPlace(columns_, scratch_);
  solution_ = columns_;
  for (const Component& c : components_) {
    const auto mass = masses_.segment(c.first, c.count);
    auto x = solution_.middleRows(c.first, c.count);
    const Eigen::RowVector3d shift = mass.transpose() * (reference_.middleRows(c.first, c.count) - x) / mass.sum();
    x.rowwise() += shift;
  }
  return solution_;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/blend_system.h"

#include <algorithm>

namespace sac {
namespace {

// The share of the mean stiffness that keeps A_i near J_i where the surroundings of a handle leave it open, as a plane
// leaves open what happens along its normal (spec.md 6.4.5). From 1e-4 to 1e-1 it makes no difference.
constexpr double kRegularization = 1e-3;

}  // namespace

void BlendSystem::SetReference(const Blend& blend, const EdgeGraph& graph, std::span<const double> weights,
                               const Eigen::VectorXd& masses, const PositionMatrix& reference) {
  functions_ = blend.functions();
  const Handles& handles = blend.handles();
  std::vector<double> off_diagonal(weights.size());
  std::transform(weights.begin(), weights.end(), off_diagonal.begin(), [](double w) { return -w; });
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(masses.size());
  for (Eigen::Index v = 0; v < diagonal.size(); ++v) {
    const auto begin = graph.offsets[static_cast<std::size_t>(v)], end = graph.offsets[static_cast<std::size_t>(v) + 1];
    for (std::uint32_t e = begin; e < end; ++e) diagonal[v] += weights[graph.edges[e]];
  }
  std::vector<Eigen::Triplet<double>> entries, pull;
  translations_.clear();
  first_translation_ = {0};
  rest_ = RowMatrix::Zero(blend.columns(), 3);
  for (std::size_t c = 0; c < functions_.size(); ++c) {
    const Component &functions = functions_[c], &run = handles.components[c];
    const auto first = static_cast<int>(functions.first);
    Eigen::SparseMatrix<double> stiffness = blend.Congruence(c, graph, {diagonal, off_diagonal});
    blend.AddPull(c, graph, weights, reference, pull);
    double sum = 0;
    for (std::uint32_t h = run.first; h < run.first + run.count; ++h) {
      const std::uint32_t t = blend.Translation(c, h);
      translations_.push_back(t);
      rest_.row(t) = reference.row(handles.vertices[h]);
      if (!blend.IsAffine(c)) continue;
      rest_.middleRows(t - Eigen::Index{3}, 3).setIdentity();
      for (std::uint32_t a = t - 3; a < t; ++a) sum += stiffness.coeff(a - functions.first, a - functions.first);
    }
    first_translation_.push_back(translations_.size());
    if (blend.IsAffine(c)) {
      const double mean = sum / (3.0 * run.count), r = mean > 0 ? kRegularization * mean : 1;
      for (std::uint32_t h = run.first; h < run.first + run.count; ++h) {
        const std::uint32_t t = blend.Translation(c, h);
        for (std::uint32_t a = 0; a < 3; ++a) {
          const auto at = static_cast<int>(t - 3 + a), gradient = static_cast<int>(3 * h + a);
          entries.emplace_back(at, at, r);
          pull.emplace_back(at, gradient, r);
        }
      }
    }
    for (int k = 0; k < stiffness.outerSize(); ++k) {
      for (Eigen::SparseMatrix<double>::InnerIterator it(stiffness, k); it; ++it) {
        entries.emplace_back(first + static_cast<int>(it.row()), first + k, it.value());
      }
    }
  }
  matrix_.resize(blend.columns(), blend.columns());
  matrix_.setFromTriplets(entries.begin(), entries.end());
  pull_.resize(blend.columns(), 3 * static_cast<Eigen::Index>(handles.vertices.size()));
  pull_.setFromTriplets(pull.begin(), pull.end());
  centroid_ = blend.TransposeTimes(masses);
  for (std::size_t c = 0; c < functions_.size(); ++c) {
    auto share = centroid_.segment(functions_[c].first, functions_[c].count);
    double mass = 0;
    for (std::size_t i = first_translation_[c]; i < first_translation_[c + 1]; ++i) mass += centroid_[translations_[i]];
    share /= mass;
  }
}

Eigen::SparseMatrix<double> BlendSystem::Tied() const {
  Eigen::SparseMatrix<double> tied;
  tied = matrix_;  // Eigen's copy constructor would lose memory when there is too little
  const double tie = std::max(matrix_.diagonal().mean(), 1.0);
  for (std::size_t c = 0; c < functions_.size(); ++c) {
    const auto t = static_cast<Eigen::Index>(translations_[first_translation_[c]]);
    tied.coeffRef(t, t) += tie;
  }
  return tied;
}

bool BlendSystem::Analyze(const FactorSize& max_size) { return solver_.Analyze(Tied(), max_size); }

bool BlendSystem::Factorize() { return solver_.Factorize(Tied()); }

Eigen::SparseMatrix<double> BlendSystem::Stiffness(std::size_t c) const {
  const auto first = static_cast<Eigen::Index>(functions_[c].first),
             count = static_cast<Eigen::Index>(functions_[c].count);
  return matrix_.block(first, first, count, count);
}

void BlendSystem::Solve(const DeformationGradients& gradients, Scratch& scratch, RowMatrix& z) const {
  scratch.gradients.resize(3 * static_cast<Eigen::Index>(gradients.size()), 3);
  for (std::size_t i = 0; i < gradients.size(); ++i) {
    scratch.gradients.middleRows(3 * static_cast<Eigen::Index>(i), 3) = gradients[i].transpose();
  }
  z.resize(pull_.rows(), 3);
  for (Eigen::Index row = 0; row < pull_.rows(); ++row) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (decltype(pull_)::InnerIterator it(pull_, row); it; ++it) {
      sum += it.value() * scratch.gradients.middleRows<1>(it.index()).leftCols<3>();
    }
    z.row(row) = sum;
  }
  solver_.SolveInPlace(z, scratch.solver);
  for (std::size_t c = 0; c < functions_.size(); ++c) {
    const Component& f = functions_[c];
    const Eigen::RowVector3d shift = centroid_.segment(f.first, f.count).transpose() *
                                     (rest_.middleRows(f.first, f.count) - z.middleRows(f.first, f.count));
    for (std::size_t i = first_translation_[c]; i < first_translation_[c + 1]; ++i) z.row(translations_[i]) += shift;
  }
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "decomposition/deflation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "decomposition/run_parallel.h"

namespace sac {
namespace {

constexpr std::size_t kChunk = 1024;    // nodes of a job
constexpr double kLeastEnergy = 1e-10;  // of the largest node's, below which a component stays empty

double LowerBound(const AlternationSettings& settings) { return settings.positive ? 0 : -1; }

// The first left singular vector of the frames x channels matrix `r`, within the bounds on weights and with a largest
// value of 1; of its two signs the one of which more is left.
Eigen::VectorXd LeadingWeights(const Eigen::MatrixXd& r, double low) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(r.transpose() * r);
  Eigen::VectorXd w = r * eigen.eigenvectors().rightCols<1>();
  const double length = w.norm();
  if (!(length > 0)) return Eigen::VectorXd::Zero(r.rows());
  w /= length;
  const Eigen::VectorXd plus = w.cwiseMax(low), minus = (-w).cwiseMax(low);
  w = plus.norm() >= minus.norm() ? plus : minus;
  return w / std::max(w.cwiseAbs().maxCoeff(), 1e-30);
}

// Adds component k at the nodes where `fade` is not zero, and takes what it explains from `energy`.
void AddFading(const NodeField& field, const std::vector<float>& fade, std::size_t k, std::uint32_t threads,
               std::vector<double>& energy, Alternation& state) {
  const auto column = static_cast<Eigen::Index>(k);
  const Eigen::VectorXd w = state.weights.col(column);
  const double square = w.squaredNorm();
  const Eigen::MatrixXf projected = field.Project(w);
  const Eigen::VectorXf before = (state.weights.leftCols(column).transpose() * w).cast<float>();
  RunParallel((field.nodes + kChunk - 1) / kChunk, threads, [&](std::size_t job) {
    for (std::size_t i = job * kChunk; i < std::min(field.nodes, (job + 1) * kChunk); ++i) {
      if (fade[i] <= 0) continue;
      double q2 = 0;
      for (std::size_t a = 0; a < field.channels; ++a) {
        const Eigen::Map<const Eigen::VectorXf> x(field.row(i) + a * field.columns,
                                                  static_cast<Eigen::Index>(field.columns));
        float* c = state.components.data() + (i * field.channels + a) * state.count;
        const float q = x.dot(projected.col(0)) - before.dot(Eigen::Map<const Eigen::VectorXf>(c, column));
        c[k] = fade[i] * q / static_cast<float>(square);
        q2 += static_cast<double>(q) * static_cast<double>(q);
      }
      const auto s = static_cast<double>(fade[i]);
      energy[i] = std::max(0.0, energy[i] - (2 * s - s * s) * q2 / square);
    }
  });
}

std::vector<double> NodeEnergies(const NodeField& field) {
  std::vector<double> energy(field.nodes);
  const std::size_t values = field.channels * field.columns;
  for (std::size_t i = 0; i < field.nodes; ++i) {
    const Eigen::Map<const Eigen::VectorXf> x(field.row(i), static_cast<Eigen::Index>(values));
    energy[i] = static_cast<double>(x.squaredNorm());
  }
  return energy;
}

// The weights with which component k, whose values are given, follows what is left of the field best.
Eigen::VectorXd WeightsOfKept(const NodeField& field, const Alternation& state, std::size_t k, double low) {
  const std::vector<float>& kept = state.sites[k].values;
  Eigen::VectorXd p = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(field.frames()));
  double square = 0;
  for (std::size_t i = 0; i < field.nodes; ++i) {
    const Eigen::Map<const Eigen::VectorXf> c(kept.data() + i * field.channels,
                                              static_cast<Eigen::Index>(field.channels));
    if (c.isZero(0) || field.mass[i] == 0) continue;
    const auto mass = static_cast<double>(field.mass[i]);
    p += mass * field.OfNode(i) * c.cast<double>();
    square += mass * c.cast<double>().squaredNorm();
  }
  if (square > 0) p /= square;
  return p.cwiseMax(low).cwiseMin(1);
}

}  // namespace

std::vector<float> SupportCost(const NodeField& field, const AlternationSettings& settings,
                               const std::vector<std::uint32_t>& nodes) {
  const double lambda = settings.sparsity * static_cast<double>(field.frames());
  const double width = settings.far - settings.near;
  const std::vector<double> distance = settings.distance(nodes, settings.near + settings.steep * width);
  std::vector<float> cost(field.nodes);
  for (std::size_t i = 0; i < field.nodes; ++i) {
    cost[i] = static_cast<float>(lambda * std::clamp((distance[i] - settings.near) / width, 0.0, settings.steep));
  }
  for (const std::uint32_t i : settings.still) cost[i] = std::numeric_limits<float>::infinity();
  return cost;
}

void Deflate(const NodeField& field, const AlternationSettings& settings, Alternation& state) {
  const double lambda = settings.sparsity * static_cast<double>(field.frames());
  std::vector<double> energy = NodeEnergies(field);
  for (const std::uint32_t i : settings.still) energy[i] = 0;
  const double most = energy.empty() ? 0 : *std::max_element(energy.begin(), energy.end());
  for (std::size_t k = 0; k < state.count; ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    ComponentSite& site = state.sites[k];
    if (!site.values.empty()) {
      state.weights.col(column) = WeightsOfKept(field, state, k, LowerBound(settings));
      for (std::size_t j = 0; j < field.nodes * field.channels; ++j) {
        state.components[j * state.count + k] = site.values[j];
      }
      continue;
    }
    if (!site.fixed) {
      site.nodes = {static_cast<std::uint32_t>(std::max_element(energy.begin(), energy.end()) - energy.begin())};
    }
    const std::uint32_t seed = *std::max_element(
        site.nodes.begin(), site.nodes.end(), [&](std::uint32_t a, std::uint32_t b) { return energy[a] < energy[b]; });
    const std::vector<float> cost = SupportCost(field, settings, site.nodes);
    for (std::size_t i = 0; i < field.nodes; ++i) state.cost[i * state.count + k] = cost[i];
    if (!(energy[seed] > kLeastEnergy * most)) continue;  // nothing is left; the component stays empty
    Eigen::MatrixXd r = field.OfNode(seed);
    for (std::size_t a = 0; a < field.channels; ++a) {
      const float* c = state.components.data() + (seed * field.channels + a) * state.count;
      r.col(static_cast<Eigen::Index>(a)) -=
          state.weights.leftCols(column) * Eigen::Map<const Eigen::VectorXf>(c, column).cast<double>();
    }
    state.weights.col(column) = LeadingWeights(r, LowerBound(settings));
    if (!(state.weights.col(column).squaredNorm() > 0)) continue;
    std::vector<float> fade(field.nodes, 0);
    for (std::size_t i = 0; i < field.nodes; ++i) {
      const double ramp = lambda > 0 ? static_cast<double>(cost[i]) / lambda : 0;
      fade[i] = static_cast<float>(1 - std::min(ramp, 1.0));
    }
    AddFading(field, fade, k, settings.threads, energy, state);
  }
}

}  // namespace sac

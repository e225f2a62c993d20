// SPDX-License-Identifier: Apache-2.0
#include "decomposition/alternation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>

#include "decomposition/component_pass.h"
#include "decomposition/deflation.h"
#include "decomposition/run_parallel.h"

namespace sac {
namespace {

constexpr int kWeightSweeps = 3;
constexpr std::uint32_t kFirstExtrapolated = 4;  // iteration
constexpr std::uint32_t kForgetRefused = 5;      // iterations after which a refused site is tried again
constexpr double kLeastShare = 1e-12;            // of the mean of |c|^2: a component that its weights are not found for
constexpr double kCancellation = 1e-5;           // of |X|^2: residuals below are computed from the differences

class Alternator {
 public:
  Alternator(const NodeField& field, const AlternationSettings& settings, Alternation& state)
      : field_(field), settings_(settings), state_(state), low_(settings.positive ? 0 : -1) {}

  Status Run();

 private:
  void Start();
  void SolveWeights();
  void MoveSites();
  void Extrapolate(std::uint32_t iteration);
  void Pass(bool update);
  double Objective() const { return state_.residual / 2 + sums_.penalty.sum(); }
  void Order();

  const NodeField& field_;
  const AlternationSettings& settings_;
  Alternation& state_;
  const double low_;
  PassSums sums_;
  double momentum_ = 1;                                // Nesterov's sequence
  Eigen::MatrixXd plain_;                              // weights of this iteration before extrapolation
  std::vector<std::optional<std::uint32_t>> refused_;  // per component, the site that was not better
};

void Alternator::Start() {
  const std::size_t count = settings_.count;
  state_ = {};
  state_.count = count;
  state_.weights = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(field_.frames()), static_cast<Eigen::Index>(count));
  state_.components.assign(field_.nodes * field_.channels * count, 0);
  state_.cost.assign(field_.nodes * count, 0);
  state_.sites = settings_.sites;
  state_.sites.resize(count);
  for (std::size_t i = 0; i < field_.nodes; ++i) {
    const Eigen::Map<const Eigen::VectorXf> x(field_.row(i),
                                              static_cast<Eigen::Index>(field_.channels * field_.columns));
    state_.square += static_cast<double>(field_.mass[i]) * static_cast<double>(x.squaredNorm());
  }
  refused_.assign(count, std::nullopt);
  Deflate(field_, settings_, state_);
}

void Alternator::Pass(bool update) {
  RunPass(field_, update, settings_.threads, state_, sums_);
  const Eigen::MatrixXd gram = state_.weights.transpose() * state_.weights;
  state_.residual = state_.square - 2 * sums_.p.cwiseProduct(state_.weights).sum() + gram.cwiseProduct(sums_.h).sum();
  if (state_.residual < kCancellation * state_.square) {
    state_.residual = ResidualSquare(field_, state_, settings_.threads);
  }
}

// Clipping is the exact minimum for each frame and component. A component whose weights stay below 1 is made smaller
// and its weights larger, by which the penalty falls.
void Alternator::SolveWeights() {
  const double least = kLeastShare * sums_.h.trace() / static_cast<double>(state_.count);
  Eigen::MatrixXd& w = state_.weights;
  for (int sweep = 0; sweep < kWeightSweeps; ++sweep) {
    for (Eigen::Index k = 0; k < w.cols(); ++k) {
      if (!(sums_.h(k, k) > least)) continue;
      w.col(k) = (w.col(k) + (sums_.p.col(k) - w * sums_.h.col(k)) / sums_.h(k, k)).cwiseMax(low_).cwiseMin(1);
    }
  }
  std::vector<float> top(state_.count, 1);
  for (std::size_t k = 0; k < state_.count; ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const double largest = w.col(column).cwiseAbs().maxCoeff();
    if (!(largest > 0) || largest == 1 || !state_.sites[k].values.empty()) continue;
    w.col(column) /= largest;
    top[k] = static_cast<float>(largest);
  }
  for (std::size_t row = 0; row < field_.nodes * field_.channels; ++row) {
    float* c = state_.components.data() + row * state_.count;
    for (std::size_t k = 0; k < state_.count; ++k) c[k] *= top[k];
  }
}

// To the node of the largest value, where that lowers the penalty. The candidates are tried side by side, each for a
// component of its own.
void Alternator::MoveSites() {
  std::vector<std::size_t> candidates;
  for (std::size_t k = 0; k < state_.count; ++k) {
    const ComponentSite& site = state_.sites[k];
    const std::uint32_t peak = sums_.peak[k];
    if (site.fixed || sums_.peak_square[k] == 0 || site.nodes.front() == peak || refused_[k] == peak) continue;
    candidates.push_back(k);
  }
  RunParallel(candidates.size(), settings_.threads, [&](std::size_t job) {
    const std::size_t k = candidates[job], count = state_.count, channels = field_.channels;
    const std::vector<std::uint32_t> there{sums_.peak[k]};
    const std::vector<float> cost = SupportCost(field_, settings_, there);
    double before = 0, after = 0;
    for (std::size_t i = 0; i < field_.nodes; ++i) {
      float square = 0;
      for (std::size_t a = 0; a < channels; ++a) {
        const float c = state_.components[(i * channels + a) * count + k];
        square += c * c;
      }
      if (square == 0) continue;
      const auto size = static_cast<double>(field_.mass[i] * std::sqrt(square));
      before += size * static_cast<double>(state_.cost[i * count + k]);
      after += size * static_cast<double>(cost[i]);
    }
    if (!(after < before)) {
      refused_[k] = there.front();
      return;
    }
    state_.sites[k].nodes = there;
    for (std::size_t i = 0; i < field_.nodes; ++i) state_.cost[i * count + k] = cost[i];
  });
}

// Keeps the plain weights, and goes on in the direction of the last step (Nesterov 1983).
void Alternator::Extrapolate(std::uint32_t iteration) {
  const Eigen::MatrixXd before = std::move(plain_);
  plain_ = state_.weights;
  if (iteration < kFirstExtrapolated) return;
  const double next = (1 + std::sqrt(1 + 4 * momentum_ * momentum_)) / 2;
  state_.weights = (plain_ + (momentum_ - 1) / next * (plain_ - before)).cwiseMax(low_).cwiseMin(1);
  for (std::size_t k = 0; k < state_.count; ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    if (!state_.sites[k].values.empty()) state_.weights.col(column) = plain_.col(column);
  }
  momentum_ = next;
}

void Alternator::Order() {
  const std::size_t count = state_.count, given = settings_.sites.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> energy(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    energy[k] = state_.weights.col(i).squaredNorm() * sums_.h(i, i);
  }
  std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(given), order.end(),
                   [&](std::size_t a, std::size_t b) { return energy[a] > energy[b]; });
  const Eigen::MatrixXd weights = state_.weights;
  const std::vector<ComponentSite> sites = state_.sites;
  for (std::size_t k = 0; k < count; ++k) {
    state_.weights.col(static_cast<Eigen::Index>(k)) = weights.col(static_cast<Eigen::Index>(order[k]));
    state_.sites[k] = sites[order[k]];
  }
  const auto permute = [&](std::vector<float>& values) {
    std::vector<float> row(count);
    for (std::size_t i = 0; i < values.size(); i += count) {
      for (std::size_t k = 0; k < count; ++k) row[k] = values[i + order[k]];
      std::copy(row.begin(), row.end(), values.begin() + static_cast<std::ptrdiff_t>(i));
    }
  };
  permute(state_.components);
  permute(state_.cost);
}

Status Alternator::Run() {
  if (settings_.progress && !settings_.progress(0, 0)) return Status::Cancelled();
  Start();
  Pass(false);
  double last = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < settings_.iterations; ++i) {
    SolveWeights();
    if (i < settings_.moving) {
      if (i % kForgetRefused == 0) refused_.assign(state_.count, std::nullopt);
      MoveSites();
    }
    Extrapolate(i);
    Pass(true);
    if (Objective() > last) {
      momentum_ = 1;
      state_.weights = plain_;
      Pass(true);
    }
    const double now = Objective();
    state_.objective.push_back(now);
    if (settings_.progress && !settings_.progress(i + 1, now)) return Status::Cancelled();
    // Not before sites rest; what a motionless clip has is 0 from the beginning.
    if (now <= 0 || (i >= settings_.moving && last - now < settings_.tolerance * now)) {
      state_.converged = true;
      break;
    }
    last = now;
  }
  Order();
  return Status::Ok();
}

}  // namespace

Status Alternate(const NodeField& field, const AlternationSettings& settings, Alternation& result) {
  return Alternator(field, settings, result).Run();
}

}  // namespace sac

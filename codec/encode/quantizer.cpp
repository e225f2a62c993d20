// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/quantizer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "format/frame_syntax.h"

namespace sac {
namespace {

constexpr double kRoundUpFrom = 0.58;  // fraction from which magnitudes beyond the dead zone are rounded up
constexpr double kLargest = 2;         // larger magnitudes count as this one in the mean of the neighbours
constexpr double kBusy = 0.7;          // mean magnitude of the neighbours from which DeadZone::busy holds

// The mean magnitude of a coefficient's neighbours. The same channel in the rows beside it and the other channels of
// its row count one half each.
double Around(const std::vector<double>& steps, std::size_t i, std::size_t channels) {
  const auto magnitude = [&](std::size_t j) { return j < steps.size() ? std::min(std::abs(steps[j]), kLargest) : 0; };
  // An index before the first wraps around to one beyond the last, whose magnitude counts as 0.
  const double rows = magnitude(i - channels) + magnitude(i + channels) +
                      0.5 * (magnitude(i - 2 * channels) + magnitude(i + 2 * channels));
  double row = -magnitude(i);
  for (std::size_t c = 0; c < channels; ++c) row += magnitude(i - i % channels + c);
  return (rows / 3 + row / static_cast<double>(channels - 1)) / 2;
}

}  // namespace

void QuantizePlane(const Eigen::MatrixXd& target, const Eigen::VectorXd& units, std::int32_t step,
                   const DeadZone& dead_zone, std::span<const std::int32_t> prediction,
                   std::span<std::int32_t> residual) {
  std::vector<double> steps;
  steps.reserve(residual.size());
  for (Eigen::Index k = 0; k < target.rows(); ++k) {
    for (Eigen::Index c = 0; c < target.cols(); ++c) {
      steps.push_back((target(k, c) / units[k] - prediction[steps.size()]) / step);
    }
  }
  const auto channels = static_cast<std::size_t>(target.cols());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double value = std::abs(steps[i]);
    double magnitude = 0;
    if (value >= std::min(dead_zone.quiet, dead_zone.busy)) {
      const double busy = std::min(Around(steps, i, channels) / kBusy, 1.0);
      const double zero_below = dead_zone.quiet + (dead_zone.busy - dead_zone.quiet) * busy;
      if (value >= zero_below) magnitude = std::max(std::floor(value + 1 - kRoundUpFrom), 1.0);
    }
    magnitude = std::min(magnitude, static_cast<double>(kMaxResidual));
    residual[i] = static_cast<std::int32_t>(steps[i] < 0 ? -magnitude : magnitude);
  }
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

namespace sac {

// The magnitudes, in steps, below which a coefficient becomes 0 (non-normative). A coefficient among zeros costs more
// bits than one among other nonzero coefficients, so the threshold is higher there.
struct DeadZone {
  double quiet;  // where all neighbours are 0
  double busy;   // where the neighbours' mean magnitude is large
};
inline constexpr DeadZone kMotionDeadZone = {0.9, 0.65};
inline constexpr DeadZone kDisplacementDeadZone = {0.7, 0.6};  // for displacement and detail

// Computes residual[k, c] = (target[k, c] / units[k] - prediction[k, c]) / step, quantized to an integer. `target` is
// harmonics x channels, `units` has the unit of each row, `step` is in units; `prediction` and `residual` are row-major
// like a plane.
void QuantizePlane(const Eigen::MatrixXd& target, const Eigen::VectorXd& units, std::int32_t step,
                   const DeadZone& dead_zone, std::span<const std::int32_t> prediction,
                   std::span<std::int32_t> residual);

}  // namespace sac

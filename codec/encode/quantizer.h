// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

namespace sac {

// Magnitudes that become 0, in steps (non-normative). A coefficient among zeros costs more bits than one among others,
// so that it has to be worth more.
struct DeadZone {
  double quiet;
  double busy;
};
inline constexpr DeadZone kMotionDeadZone = {0.9, 0.65};
inline constexpr DeadZone kDisplacementDeadZone = {0.7, 0.6};  // and detail

// residual[k, c] = (target[k, c] / units[k] - prediction[k, c]) / step, quantized; row-major like a plane.
void QuantizePlane(const Eigen::MatrixXd& target, const Eigen::VectorXd& units, std::int32_t step,
                   const DeadZone& dead_zone, std::span<const std::int32_t> prediction,
                   std::span<std::int32_t> residual);

}  // namespace sac

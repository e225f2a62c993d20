#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "format/frame_syntax.h"

namespace sac {

// Uniform quantization with a dead zone: magnitudes are rounded up from 0.65 (non-normative).
inline std::int32_t QuantizeWithDeadZone(double value) {
  const double magnitude = std::min(std::floor(std::abs(value) + 0.35), static_cast<double>(kMaxResidual));
  return static_cast<std::int32_t>(value < 0 ? -magnitude : magnitude);
}

// residual[k, c] = (target[k, c] / units[k] - prediction[k, c]) / step, quantized; row-major like a plane.
inline void QuantizePlane(const Eigen::MatrixXd& target, const Eigen::VectorXd& units, std::int32_t step,
                          std::span<const std::int32_t> prediction, std::span<std::int32_t> residual) {
  std::size_t i = 0;
  for (Eigen::Index k = 0; k < target.rows(); ++k) {
    for (Eigen::Index c = 0; c < target.cols(); ++c, ++i) {
      residual[i] = QuantizeWithDeadZone((target(k, c) / units[k] - prediction[i]) / step);
    }
  }
}

}  // namespace sac

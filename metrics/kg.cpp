// SPDX-License-Identifier: Apache-2.0
#include "metrics/kg.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace sac {

void KgError::Add(const Positions& original, const Positions& decoded) {
  const std::size_t n = original.size();
  if (n == 0) return;
  std::array<double, 3> mean{};
  for (const Vec3f& p : original) {
    for (int c = 0; c < 3; ++c) mean[c] += p[c];
  }
  for (double& m : mean) m /= static_cast<double>(n);

  // Sums of their own for each frame: one sum over a long clip loses digits.
  double error = 0, spread = 0;
  for (std::size_t v = 0; v < n; ++v) {
    for (int c = 0; c < 3; ++c) {
      const double a = original[v][c], d = a - decoded[v][c], s = a - mean[c];
      error += d * d;
      spread += s * s;
    }
  }
  error_ += error;
  spread_ += spread;
}

double KgError::Value() const {
  if (error_ == 0) return 0;
  if (spread_ == 0 && error_ > 0) return std::numeric_limits<double>::infinity();
  return 100 * std::sqrt(error_ / spread_);
}

}  // namespace sac

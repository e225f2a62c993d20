// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "format/logistic.h"

namespace sac {

// Estimates the probability that a bin is 1 from the bins it has seen (spec.md 7.2). Early bins move it more.
class BitModel {
 public:
  // The probability in 1/65536, from 61 to 65474.
  std::uint32_t probability() const { return probability_; }
  // The logit of the probability, damped towards 0 (no information) while the model has seen few bins.
  std::int32_t logit() const { return Logit(probability_) * static_cast<std::int32_t>(kConfidence[count_]) >> 8; }

  void Update(bool bit) {
    // The probability and all rates are below 2^16, so the products fit 32 bits.
    if (bit) {
      probability_ = static_cast<std::uint16_t>(probability_ + (((65535u - probability_) * kRates[count_]) >> 16));
    } else {
      probability_ = static_cast<std::uint16_t>(probability_ - ((probability_ * kRates[count_]) >> 16));
    }
    if (count_ < kMaxSeen) ++count_;
  }

 private:
  static constexpr std::size_t kMaxSeen = 60;
  static constexpr std::array<std::uint32_t, kMaxSeen + 1> kConfidence = [] {
    std::array<std::uint32_t, kMaxSeen + 1> values{};
    for (std::uint32_t n = 0; n <= kMaxSeen; ++n) values[n] = 512 * n / (2 * n + 3);
    return values;
  }();
  static constexpr std::array<std::uint32_t, kMaxSeen + 1> kRates = [] {
    std::array<std::uint32_t, kMaxSeen + 1> values{};
    for (std::uint32_t n = 0; n <= kMaxSeen; ++n) values[n] = 655360 / (10 * n + 16);
    return values;
  }();

  std::uint16_t probability_ = 32768;
  std::uint16_t count_ = 0;
};

}  // namespace sac

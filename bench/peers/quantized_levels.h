// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bench/peers/count_coder.h"

namespace sac::bench {

// Quantizes the coefficients of each of kChannels channels uniformly between the least and the greatest value of the
// channel, to integers of `bits` bits (Wang et al. 2015).
struct Quantizer {
  static constexpr std::size_t kChannels = 9;

  std::array<float, kChannels> low, high;
  std::uint32_t bits;

  double Step(std::size_t channel) const {
    return (static_cast<double>(high[channel]) - static_cast<double>(low[channel])) / ((1u << bits) - 1);
  }
  std::uint32_t Level(double value, std::size_t channel) const {
    const double step = Step(channel), most = (1u << bits) - 1;
    const double level = (value - static_cast<double>(low[channel])) / step;
    return step > 0 ? static_cast<std::uint32_t>(std::lround(std::clamp(level, 0.0, most))) : 0;
  }
  double Value(std::uint32_t level, std::size_t channel) const {
    return static_cast<double>(low[channel]) + Step(channel) * level;
  }
};

// Codes levels with the frequencies `counts`, which a decoder must have before. When `counts` is null, each level is
// coded as `bits` bits.
template <class Coder>
void CodeLevels(Coder& coder, const SymbolCounts* counts, std::uint32_t bits, std::vector<std::uint32_t>& levels) {
  for (std::uint32_t& level : levels) {
    if (counts != nullptr) {
      CodeSymbol(coder, *counts, level);
    } else {
      coder.Raw(level, static_cast<int>(bits));
    }
  }
}

}  // namespace sac::bench

// SPDX-License-Identifier: Apache-2.0
#include "format/harmonic_order.h"

#include <algorithm>
#include <cstddef>

#include "format/logistic.h"

namespace sac {

std::vector<HarmonicIndex> HarmonicOrder(std::span<const std::uint32_t> counts) {
  std::vector<HarmonicIndex> order;
  for (std::uint32_t c = 0; c < counts.size(); ++c) {
    for (std::uint32_t k = 0; k < counts[c]; ++k) order.push_back({c, k});
  }
  std::stable_sort(order.begin(), order.end(), [&](const HarmonicIndex& a, const HarmonicIndex& b) {
    return static_cast<std::uint64_t>(a.k) * counts[b.component] <
           static_cast<std::uint64_t>(b.k) * counts[a.component];
  });
  return order;
}

std::uint8_t HarmonicClass(std::uint32_t k) {
  return static_cast<std::uint8_t>(std::min<std::uint32_t>(HalfOctave(k + 1), 23));
}

}  // namespace sac

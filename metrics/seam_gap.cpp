// SPDX-License-Identifier: Apache-2.0
#include "metrics/seam_gap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace sac {

void SeamGap::Add(const Positions& original, const Positions& decoded) {
  if (!begun_) {
    begun_ = true;
    std::vector<std::uint32_t> order(original.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return original[a] != original[b] ? original[a] < original[b] : a < b;
    });
    for (std::size_t i = 1, first = 0; i < order.size(); ++i) {
      if (original[order[i]] == original[order[first]]) {
        pairs_.push_back({order[first], order[i], 0});
      } else {
        first = i;
      }
    }
  }
  std::erase_if(pairs_, [&](const Pair& pair) { return original[pair.first] != original[pair.second]; });
  for (Pair& pair : pairs_) {
    double gap2 = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = double{decoded[pair.first][c]} - decoded[pair.second][c];
      gap2 += d * d;
    }
    pair.gap2 = std::max(pair.gap2, gap2);
  }
}

double SeamGap::Value() const {
  double gap2 = 0;
  for (const Pair& pair : pairs_) gap2 = std::max(gap2, pair.gap2);
  return std::sqrt(gap2);
}

}  // namespace sac

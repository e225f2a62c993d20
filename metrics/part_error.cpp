// SPDX-License-Identifier: Apache-2.0
#include "metrics/part_error.h"

#include <algorithm>
#include <cmath>

#include "geometry/components.h"

namespace sac {

PartError::PartError(std::span<const Triangle> triangles, std::size_t vertices) {
  std::uint32_t count = 0;
  labels_ = LabelComponents(static_cast<std::uint32_t>(vertices), triangles, count);
  parts_.resize(count);
  sums_.resize(count);
  for (std::size_t v = 0; v < vertices; ++v) {
    Part& part = parts_[labels_[v]];
    if (part.vertices++ == 0) part.first = static_cast<std::uint32_t>(v);
  }
}

void PartError::Add(const Positions& original, const Positions& decoded) {
  std::fill(sums_.begin(), sums_.end(), Sums{});
  for (std::size_t v = 0; v < original.size(); ++v) {
    Part& part = parts_[labels_[v]];
    Sums& sums = sums_[labels_[v]];
    double error2 = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double error = double{decoded[v][c]} - original[v][c];
      const double offset = double{original[v][c]} - original[part.first][c];
      error2 += error * error;
      sums.sum[c] += offset;
      sums.square += offset * offset;
    }
    part.error2 += error2;
    part.max_error2 = std::max(part.max_error2, error2);
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    double mean2 = 0;
    for (const double sum : sums_[p].sum) mean2 += sum * sum / parts_[p].vertices;
    parts_[p].spread2 += std::max(sums_[p].square - mean2, 0.0);
  }
}

PartDistortion PartError::Worst() const {
  PartDistortion worst;
  for (const Part& part : parts_) {
    if (part.spread2 <= 0) continue;
    const double kg = 100 * std::sqrt(part.error2 / part.spread2);
    if (worst.vertices > 0 && kg <= worst.kg) continue;
    worst = {kg, std::sqrt(part.max_error2), part.first, part.vertices};
  }
  return worst;
}

}  // namespace sac

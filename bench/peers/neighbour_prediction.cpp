// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/neighbour_prediction.h"

#include <algorithm>
#include <cmath>

namespace sac::bench {

NeighbourPrediction::NeighbourPrediction(const std::vector<Triangle>& triangles, std::size_t vertices,
                                         std::size_t channels)
    : triangles_(triangles), around_(vertices), rank_(vertices), values_(vertices), predicted_(channels) {
  for (std::uint32_t j = 0; j < triangles.size(); ++j) {
    for (const std::uint32_t v : triangles[j]) around_[v].push_back(j);
  }
  Walk();
  for (std::uint32_t i = 0; i < order_.size(); ++i) rank_[order_[i]] = i;
}

// Orders the vertices breadth first, so that every vertex but the first few has a triangle of earlier vertices beside
// it.
void NeighbourPrediction::Walk() {
  std::vector<bool> seen(around_.size());
  for (std::uint32_t start = 0; start < around_.size(); ++start) {
    if (seen[start]) continue;
    seen[start] = true;
    std::size_t next = order_.size();
    order_.push_back(start);
    for (; next < order_.size(); ++next) {
      for (const std::uint32_t j : around_[order_[next]]) {
        for (const std::uint32_t v : triangles_[j]) {
          if (!seen[v]) order_.push_back(v);
          seen[v] = true;
        }
      }
    }
  }
}

const std::vector<int>& NeighbourPrediction::Predict(std::size_t i) {
  const std::uint32_t v = order_[i];
  std::vector<double> parallelograms(predicted_.size()), mean(predicted_.size());
  double count = 0, neighbours = 0;
  const auto known = [&](std::uint32_t u) { return rank_[u] < i; };
  for (const std::uint32_t j : around_[v]) {
    const Triangle& t = triangles_[j];
    const std::size_t corner = t[0] == v ? 0 : t[1] == v ? 1 : 2;
    const std::uint32_t a = t[(corner + 1) % 3], b = t[(corner + 2) % 3];
    for (const std::uint32_t u : {a, b}) {
      if (!known(u)) continue;
      for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += values_[u][k];
      ++neighbours;
    }
    if (!known(a) || !known(b)) continue;
    for (const std::uint32_t other : around_[a]) {
      const Triangle& o = triangles_[other];
      if (other == j || std::find(o.begin(), o.end(), b) == o.end()) continue;
      const std::uint32_t c = o[0] + o[1] + o[2] - a - b;
      if (c == v || !known(c)) continue;
      for (std::size_t k = 0; k < mean.size(); ++k) parallelograms[k] += values_[a][k] + values_[b][k] - values_[c][k];
      ++count;
    }
  }
  for (std::size_t k = 0; k < predicted_.size(); ++k) {
    const double value = count > 0 ? parallelograms[k] / count : neighbours > 0 ? mean[k] / neighbours : 0;
    predicted_[k] = static_cast<int>(std::lround(value));
  }
  return predicted_;
}

void NeighbourPrediction::Set(std::size_t i, const std::vector<int>& value) { values_[order_[i]] = value; }

}  // namespace sac::bench

// SPDX-License-Identifier: Apache-2.0
#include "geometry/coincident_vertices.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace sac {

void CoincidentVertices::Add(std::span<const Vec3f> positions) {
  const auto before = [&](std::uint32_t a, std::uint32_t b) { return positions[a] < positions[b]; };
  if (!begun_) {
    begun_ = true;
    lowest_.resize(positions.size());
    std::iota(lowest_.begin(), lowest_.end(), 0u);
    std::vector<std::uint32_t> order = lowest_;
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return before(a, b) || (!before(b, a) && a < b); });
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (positions[order[i]] == positions[order[i - 1]]) lowest_[order[i]] = lowest_[order[i - 1]];
    }
  } else {
    // Vertices that part from their lowest may still coincide with each other.
    std::vector<std::uint32_t> parted;
    for (const std::uint32_t v : others_) {
      if (positions[v] != positions[lowest_[v]]) parted.push_back(v);
    }
    if (parted.empty()) return;
    std::sort(parted.begin(), parted.end(), [&](std::uint32_t a, std::uint32_t b) {
      if (lowest_[a] != lowest_[b]) return lowest_[a] < lowest_[b];
      return before(a, b) || (!before(b, a) && a < b);
    });
    std::vector<std::uint32_t> lowest(parted);
    for (std::size_t i = 1; i < parted.size(); ++i) {
      const std::uint32_t a = parted[i - 1], b = parted[i];
      if (lowest_[a] == lowest_[b] && positions[a] == positions[b]) lowest[i] = lowest[i - 1];
    }
    for (std::size_t i = 0; i < parted.size(); ++i) lowest_[parted[i]] = lowest[i];
  }
  others_.clear();
  for (std::uint32_t v = 0; v < lowest_.size(); ++v) {
    if (lowest_[v] != v) others_.push_back(v);
  }
}

std::vector<std::uint32_t> CoincidentVertices::Lowest() const { return any() ? lowest_ : std::vector<std::uint32_t>(); }

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "files/welding.h"

#include <array>
#include <bit>
#include <unordered_map>

namespace sac {
namespace {

using Key = std::array<std::uint64_t, 4>;  // the vertex so far, and the position

struct Hash {
  std::size_t operator()(const Key& key) const {
    std::uint64_t hash = 0;
    for (const std::uint64_t x : key) {
      hash = (hash ^ x) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash);
  }
};

}  // namespace

void Welding::Add(const std::vector<Vec3d>& corners) {
  vertices_.resize(corners.size());
  first_corner_.clear();
  std::unordered_map<Key, std::uint32_t, Hash> index;
  for (std::uint32_t corner = 0; corner < corners.size(); ++corner) {
    Key key = {vertices_[corner]};
    for (int k = 0; k < 3; ++k) {
      const double x = corners[corner][k];
      key[k + 1] = std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x);
    }
    const auto [found, added] = index.try_emplace(key, static_cast<std::uint32_t>(first_corner_.size()));
    if (added) first_corner_.push_back(corner);
    vertices_[corner] = found->second;
  }
}

}  // namespace sac

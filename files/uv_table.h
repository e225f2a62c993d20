// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace sac {

// Collects texture coordinates, each value once, in the order of first use.
class UvTable {
 public:
  // The index of `uv`, compared by its bits.
  std::uint32_t Index(const std::array<float, 2>& uv) {
    const std::uint64_t key =
        static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(uv[0])) << 32 | std::bit_cast<std::uint32_t>(uv[1]);
    const auto [found, added] = index_.try_emplace(key, static_cast<std::uint32_t>(uvs_.size()));
    if (added) uvs_.push_back(uv);
    return found->second;
  }

  std::vector<std::array<float, 2>> Take() { return std::move(uvs_); }

 private:
  std::vector<std::array<float, 2>> uvs_;
  std::unordered_map<std::uint64_t, std::uint32_t> index_;
};

}  // namespace sac

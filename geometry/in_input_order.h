// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sac {

// What the vertices of a decoded mesh have, in the order of the input. `order` has for each decoded vertex its index
// there, a permutation.
template <class T>
std::vector<T> InInputOrder(const std::vector<T>& decoded, const std::vector<std::uint32_t>& order) {
  std::vector<T> out(decoded.size());
  for (std::size_t v = 0; v < decoded.size(); ++v) out[order[v]] = decoded[v];
  return out;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "geometry/components.h"

#include <numeric>

namespace sac {

std::vector<std::uint32_t> LabelComponents(std::uint32_t vertices, std::span<const Triangle> triangles,
                                           std::uint32_t& components) {
  // Disjoint sets whose root is always the smallest member.
  std::vector<std::uint32_t> parent(vertices);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    if (a < b) {
      parent[b] = a;
    } else {
      parent[a] = b;
    }
  };
  for (const Triangle& t : triangles) {
    join(t[0], t[1]);
    join(t[1], t[2]);
  }
  components = 0;
  std::vector<std::uint32_t> label(vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) label[v] = parent[v] == v ? components++ : label[root(v)];
  return label;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// A connected component: the vertices [first, first + count).
struct Component {
  std::uint32_t first;
  std::uint32_t count;
};

// Returns for each of `vertices` vertices the number of its connected component over the edges of `triangles`,
// degenerate triangles included. Components are numbered by their smallest vertex; `components` becomes their count.
std::vector<std::uint32_t> LabelComponents(std::uint32_t vertices, std::span<const Triangle> triangles,
                                           std::uint32_t& components);

}  // namespace sac

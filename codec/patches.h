// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/grid_position.h"
#include "geometry/edges.h"

namespace sac {

// The vertices of a component in an order in which each patch is a run of consecutive vertices.
struct PatchOrder {
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint32_t> sizes;  // vertices of each patch, in that order
};

// Cuts one component into connected patches of at most `size` vertices (spec.md 5.4). The component is halved by
// position along its longest axis, and its halves again, until they are small enough; each connected piece of a half is
// a patch. All computation is in integers.
PatchOrder CutIntoPatches(std::span<const GridPosition> grid, const VertexGraph& graph,
                          std::vector<std::uint32_t> component, std::uint32_t size);

}  // namespace sac

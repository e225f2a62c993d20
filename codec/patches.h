// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/grid_position.h"
#include "geometry/edges.h"

namespace sac {

// Vertices of a component in an order in which each patch is a run, and the patches' sizes.
struct PatchOrder {
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint32_t> sizes;
};

// Cuts one component into connected patches of at most `size` vertices (spec.md 5.4): halves by position along the
// longest axis, integers alone, then the connected pieces of what is left.
PatchOrder CutIntoPatches(std::span<const GridPosition> grid, const VertexGraph& graph,
                          std::vector<std::uint32_t> component, std::uint32_t size);

}  // namespace sac

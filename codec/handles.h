// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/grid_position.h"
#include "geometry/components.h"
#include "geometry/edges.h"
#include "sac/status.h"

namespace sac {

// The handles that move a mesh (spec.md 6.4.4): vertices spread over each component, and for each vertex the handles
// that it follows, with their weights. A component of which every vertex is a handle has weights of 1.
struct Handles {
  std::vector<std::uint32_t> vertices;  // of each handle the vertex at which it stands
  std::vector<Component> components;    // of each component the run of its handles
  std::vector<std::uint32_t> offsets;   // vertex v follows the handles from followed[offsets[v]] on
  std::vector<std::uint32_t> followed;  // handles, the nearest first
  std::vector<double> weights;          // of each of `followed`; those of a vertex are positive and sum to 1
  // Of each handle the nearest among the first handles of its component, the leaders.
  std::vector<std::uint32_t> leaders;

  std::span<const std::uint32_t> FollowedBy(std::uint32_t vertex) const {
    return std::span(followed).subspan(offsets[vertex], offsets[vertex + 1] - offsets[vertex]);
  }
  const double* WeightsOf(std::uint32_t vertex) const { return weights.data() + offsets[vertex]; }
};

// The number of handles of a component (spec.md 6.4.4): `handles_per_harmonic` for each of its harmonics, but all
// vertices where they are not at least four times as many, or where handles_per_harmonic is 0.
std::uint32_t HandleCount(std::uint32_t vertices, std::uint32_t harmonics, std::uint32_t handles_per_harmonic);

// How many handles of a component lead (spec.md 6.4.6): four for three harmonics, if there are as many.
std::uint32_t LeaderCount(std::uint32_t handles, std::uint32_t harmonics);

// The length of each edge as an integer: 64ths of a cell of the position grid, rounded down, at least 1.
std::vector<std::uint32_t> EdgeLengths(const EdgeList& edges, std::span<const GridPosition> grid);

// Chooses `counts` handles in each of `components`, 1 to its number of vertices, of which the first `leaders` lead.
// Distances are sums of `lengths` along edges, integers, so that every decoder chooses the same handles.
//
// Returns kLimit when it takes more than `max_work` steps. They are few on a surface, but the time of a graph of
// another kind cannot be told before.
Status ChooseHandles(const EdgeGraph& graph, std::span<const std::uint32_t> lengths,
                     std::span<const Component> components, std::span<const std::uint32_t> counts,
                     std::span<const std::uint32_t> leaders, double max_work, Handles& handles);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// The connectivity that positions are predicted from (spec.md 5.5.1): which vertices are neighbours, and which vertices
// lie opposite each edge. Vertices with more than 32 neighbours are treated as having none, which bounds the work per
// vertex.
class PositionGraph {
 public:
  PositionGraph(std::uint32_t vertices, std::span<const Triangle> triangles);

  std::uint32_t vertices() const { return static_cast<std::uint32_t>(first_.size()) - 1; }
  // The neighbours of `v`, ascending.
  std::span<const std::uint32_t> Neighbors(std::uint32_t v) const {
    return std::span(neighbors_).subspan(first_[v], first_[v + 1] - first_[v]);
  }
  // The third vertices of the triangles on the edge from `a` to `b`, ascending. `a` must be less than `b`. Empty when
  // the graph has no such edge.
  std::span<const std::uint32_t> Across(std::uint32_t a, std::uint32_t b) const;

  // All vertices in coding order: the next vertex is always one with the most neighbours already taken (spec.md 5.5.2).
  std::vector<std::uint32_t> CodingOrder() const;

 private:
  std::vector<std::uint32_t> first_, neighbors_;
  std::vector<std::uint32_t> first_across_, across_;  // first_across_ is indexed like neighbors_
};

}  // namespace sac

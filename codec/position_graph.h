// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// What the prediction of positions knows of a mesh before any of them (spec.md 5.5.1): which vertices are neighbours,
// and what lies across an edge. Vertices with more than 32 neighbours are left out, so that a vertex costs a bounded
// amount of work.
class PositionGraph {
 public:
  PositionGraph(std::uint32_t vertices, std::span<const Triangle> triangles);

  std::uint32_t vertices() const { return static_cast<std::uint32_t>(first_.size()) - 1; }
  // Ascending.
  std::span<const std::uint32_t> Neighbors(std::uint32_t v) const {
    return std::span(neighbors_).subspan(first_[v], first_[v + 1] - first_[v]);
  }
  // The third vertices of the triangles on the edge between `a` and a larger `b`, ascending; none if that is no edge.
  std::span<const std::uint32_t> Across(std::uint32_t a, std::uint32_t b) const;

  // All vertices, each as late as its number of neighbours before it is small (spec.md 5.5.2).
  std::vector<std::uint32_t> CodingOrder() const;

 private:
  std::vector<std::uint32_t> first_, neighbors_;
  std::vector<std::uint32_t> first_across_, across_;  // by the edge's place in neighbors_
};

}  // namespace sac

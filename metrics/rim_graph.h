// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// A list of lists: list i is items[start[i]] .. items[start[i + 1] - 1].
struct IndexLists {
  std::vector<std::size_t> start;
  std::vector<std::uint32_t> items;
};

// The undirected edges of a mesh, each once, without the loops of degenerate triangles, and the rims of its vertices.
struct RimGraph {
  struct Edge {
    std::uint32_t a, b;  // a < b
  };
  // A step from a vertex along the edge `edge` to its neighbour `vertex`.
  struct Spoke {
    std::uint32_t vertex, edge;
  };
  std::vector<Edge> edges;               // in ascending order
  std::vector<std::size_t> spoke_start;  // per vertex, one more at the end
  std::vector<Spoke> spokes;
  IndexLists rim;  // per vertex: the edges between two of its neighbours

  std::size_t vertices() const { return spoke_start.size() - 1; }
};

// Builds the graph of `triangles`, whose indices are all below `vertices`. Memory is linear in the edges and in the
// three-cycles they form, which in a surface are about the triangles.
RimGraph BuildRimGraph(const std::vector<Triangle>& triangles, std::size_t vertices);

}  // namespace sac

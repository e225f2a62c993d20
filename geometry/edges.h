// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// The undirected edges of a triangle mesh, each once, in ascending order. Edges of degenerate triangles are included,
// loops from a vertex to itself are not.
struct EdgeList {
  std::vector<std::array<std::uint32_t, 2>> ends;         // smaller vertex first
  std::vector<std::array<std::uint32_t, 3>> of_triangle;  // edge opposite corner k of triangle j; kNone for a loop
  static constexpr std::uint32_t kNone = 0xffffffffu;
};

// The edges of `triangles`.
EdgeList BuildEdges(std::span<const Triangle> triangles);

// A range of edges [begin, begin + count) of an EdgeList.
struct EdgeRange {
  std::size_t begin;
  std::size_t count;
};

// The edges whose smaller vertex is in [first, first + count).
EdgeRange EdgesOf(const EdgeList& edges, std::uint32_t first, std::uint32_t count);

// The edges at each vertex: vertex v has those from offsets[v] to offsets[v + 1] - 1. Each leads to a vertex of
// `neighbours` and is the edge number `edges` of the list.
struct EdgeGraph {
  std::vector<std::uint32_t> offsets;
  std::vector<std::uint32_t> neighbours;
  std::vector<std::uint32_t> edges;
};
EdgeGraph BuildEdgeGraph(std::uint32_t vertices, const EdgeList& list);

// The neighbours of each vertex along edges: vertex v has neighbours[offsets[v]] to neighbours[offsets[v + 1] - 1].
struct VertexGraph {
  std::vector<std::uint32_t> offsets;
  std::vector<std::uint32_t> neighbours;
};
// The graph of the edges of `triangles`, whose indices are below `vertices`.
VertexGraph BuildGraph(std::uint32_t vertices, std::span<const Triangle> triangles);

}  // namespace sac

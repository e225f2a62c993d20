// SPDX-License-Identifier: Apache-2.0
#include "metrics/rim_graph.h"

#include <algorithm>
#include <cassert>

namespace sac {
namespace {

std::vector<RimGraph::Edge> UniqueEdges(const std::vector<Triangle>& triangles) {
  std::vector<std::uint64_t> keys;
  keys.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      if (low != high) keys.push_back(std::uint64_t{low} << 32 | high);
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::vector<RimGraph::Edge> edges;
  edges.reserve(keys.size());
  for (std::uint64_t key : keys) {
    edges.push_back({static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)});
  }
  return edges;
}

// Turns counts per list (at index i + 1) into the starts of the lists.
void CountsToStarts(std::vector<std::size_t>& counts) {
  for (std::size_t i = 1; i < counts.size(); ++i) counts[i] += counts[i - 1];
}

void BuildSpokes(RimGraph& graph, std::size_t vertices) {
  graph.spoke_start.assign(vertices + 1, 0);
  for (const auto& e : graph.edges) {
    ++graph.spoke_start[e.a + 1];
    ++graph.spoke_start[e.b + 1];
  }
  CountsToStarts(graph.spoke_start);
  graph.spokes.resize(2 * graph.edges.size());
  std::vector<std::size_t> next(graph.spoke_start.begin(), graph.spoke_start.end() - 1);
  for (std::uint32_t i = 0; i < graph.edges.size(); ++i) {
    const auto [a, b] = graph.edges[i];
    graph.spokes[next[a]++] = {b, i};
    graph.spokes[next[b]++] = {a, i};
  }
}

// Calls visit(vertex, rim edge) for the three vertices of every three-cycle. Each edge points to its end of higher
// degree, so that a vertex has O(sqrt(edges)) outgoing edges and one hub vertex cannot make the search quadratic.
template <class Visit>
void ForEachRimEdge(const RimGraph& graph, Visit visit) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  const auto& start = graph.spoke_start;
  const auto points_to = [&](std::uint32_t from, std::uint32_t to) {
    const std::size_t df = start[from + 1] - start[from], dt = start[to + 1] - start[to];
    return df != dt ? df < dt : from < to;
  };
  std::vector<RimGraph::Spoke> out;
  std::vector<std::size_t> out_start{0};
  out.reserve(graph.edges.size());
  for (std::uint32_t v = 0; v < graph.vertices(); ++v) {
    for (std::size_t i = start[v]; i < start[v + 1]; ++i) {
      if (points_to(v, graph.spokes[i].vertex)) out.push_back(graph.spokes[i]);
    }
    out_start.push_back(out.size());
  }
  std::vector<std::uint32_t> edge_to(graph.vertices(), kNone);  // the edge from the current vertex
  for (std::uint32_t u = 0; u < graph.vertices(); ++u) {
    for (std::size_t i = out_start[u]; i < out_start[u + 1]; ++i) edge_to[out[i].vertex] = out[i].edge;
    for (std::size_t i = out_start[u]; i < out_start[u + 1]; ++i) {
      const auto [v, uv] = out[i];
      for (std::size_t j = out_start[v]; j < out_start[v + 1]; ++j) {
        const auto [w, vw] = out[j];
        if (edge_to[w] == kNone) continue;
        visit(u, vw);
        visit(v, edge_to[w]);
        visit(w, uv);
      }
    }
    for (std::size_t i = out_start[u]; i < out_start[u + 1]; ++i) edge_to[out[i].vertex] = kNone;
  }
}

}  // namespace

RimGraph BuildRimGraph(const std::vector<Triangle>& triangles, std::size_t vertices) {
  assert(std::all_of(triangles.begin(), triangles.end(),
                     [&](const Triangle& t) { return *std::max_element(t.begin(), t.end()) < vertices; }));
  RimGraph graph;
  graph.edges = UniqueEdges(triangles);
  BuildSpokes(graph, vertices);

  graph.rim.start.assign(vertices + 1, 0);
  ForEachRimEdge(graph, [&](std::uint32_t v, std::uint32_t) { ++graph.rim.start[v + 1]; });
  CountsToStarts(graph.rim.start);
  graph.rim.items.resize(graph.rim.start.back());
  std::vector<std::size_t> next(graph.rim.start.begin(), graph.rim.start.end() - 1);
  ForEachRimEdge(graph, [&](std::uint32_t v, std::uint32_t edge) { graph.rim.items[next[v]++] = edge; });
  return graph;
}

}  // namespace sac

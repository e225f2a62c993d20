// SPDX-License-Identifier: Apache-2.0
#include "geometry/edges.h"

#include <algorithm>

namespace sac {

EdgeList BuildEdges(std::span<const Triangle> triangles) {
  EdgeList edges;
  edges.ends.reserve(3 * triangles.size());
  const auto edge = [&](std::size_t j, std::size_t k) {
    const std::uint32_t a = triangles[j][(k + 1) % 3], b = triangles[j][(k + 2) % 3];
    return std::array<std::uint32_t, 2>{std::min(a, b), std::max(a, b)};
  };
  for (std::size_t j = 0; j < triangles.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (const auto e = edge(j, k); e[0] != e[1]) edges.ends.push_back(e);
    }
  }
  std::sort(edges.ends.begin(), edges.ends.end());
  edges.ends.erase(std::unique(edges.ends.begin(), edges.ends.end()), edges.ends.end());
  edges.of_triangle.resize(triangles.size());
  for (std::size_t j = 0; j < triangles.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto e = edge(j, k);
      edges.of_triangle[j][k] =
          e[0] == e[1] ? EdgeList::kNone
                       : static_cast<std::uint32_t>(std::lower_bound(edges.ends.begin(), edges.ends.end(), e) -
                                                    edges.ends.begin());
    }
  }
  return edges;
}

EdgeRange EdgesOf(const EdgeList& edges, std::uint32_t first, std::uint32_t count) {
  const auto at = [&](std::uint32_t v) {
    return std::lower_bound(edges.ends.begin(), edges.ends.end(), std::array<std::uint32_t, 2>{v, 0});
  };
  const auto begin = at(first), end = at(first + count);
  return {static_cast<std::size_t>(begin - edges.ends.begin()), static_cast<std::size_t>(end - begin)};
}

EdgeGraph BuildEdgeGraph(std::uint32_t vertices, const EdgeList& list) {
  EdgeGraph graph;
  graph.offsets.assign(vertices + 1, 0);
  for (const auto& ends : list.ends) {
    for (const std::uint32_t v : ends) ++graph.offsets[v + 1];
  }
  for (std::uint32_t v = 0; v < vertices; ++v) graph.offsets[v + 1] += graph.offsets[v];
  graph.neighbours.resize(graph.offsets[vertices]);
  graph.edges.resize(graph.offsets[vertices]);
  std::vector<std::uint32_t> next(graph.offsets.begin(), graph.offsets.end() - 1);
  for (std::uint32_t e = 0; e < list.ends.size(); ++e) {
    const auto [a, b] = list.ends[e];
    graph.neighbours[next[a]] = b;
    graph.edges[next[a]++] = e;
    graph.neighbours[next[b]] = a;
    graph.edges[next[b]++] = e;
  }
  return graph;
}

VertexGraph BuildGraph(std::uint32_t vertices, std::span<const Triangle> triangles) {
  VertexGraph graph;
  graph.offsets.assign(vertices + 1, 0);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) graph.offsets[v + 1] += 2;
  }
  for (std::uint32_t v = 0; v < vertices; ++v) graph.offsets[v + 1] += graph.offsets[v];
  graph.neighbours.resize(graph.offsets[vertices]);
  std::vector<std::uint32_t> next(graph.offsets.begin(), graph.offsets.end() - 1);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      graph.neighbours[next[t[k]]++] = t[(k + 1) % 3];
      graph.neighbours[next[t[k]]++] = t[(k + 2) % 3];
    }
  }
  return graph;
}

}  // namespace sac

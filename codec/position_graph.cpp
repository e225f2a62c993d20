// SPDX-License-Identifier: Apache-2.0
#include "codec/position_graph.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace sac {
namespace {

constexpr std::uint32_t kMaxNeighbors = 32;
constexpr std::size_t kMaxCounted = 4;

template <class T>
void SortUnique(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

PositionGraph::PositionGraph(std::uint32_t vertices, std::span<const Triangle> triangles) {
  using Edge = std::array<std::uint32_t, 2>;
  std::vector<Triangle> sets;
  std::vector<Edge> edges;  // in both directions
  for (Triangle t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (a == b) continue;
      edges.push_back({a, b});
      edges.push_back({b, a});
    }
    std::sort(t.begin(), t.end());
    if (t[0] != t[1] && t[1] != t[2]) sets.push_back(t);
  }
  SortUnique(edges);
  SortUnique(sets);
  std::vector<std::uint32_t> valence(vertices, 0);
  for (const Edge& e : edges) ++valence[e[0]];
  const auto kept = [&](std::uint32_t v) { return valence[v] <= kMaxNeighbors; };

  first_.assign(vertices + std::size_t{1}, 0);
  for (const Edge& e : edges) {
    if (!kept(e[0]) || !kept(e[1])) continue;
    neighbors_.push_back(e[1]);
    ++first_[e[0] + std::size_t{1}];
  }
  for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];

  // Each entry is an edge and the vertex opposite it. Sorted, the entries of an edge stand together, and edges follow
  // in the order of neighbors_.
  std::vector<Triangle> across;
  for (const Triangle& t : sets) {
    if (!kept(t[0]) || !kept(t[1]) || !kept(t[2])) continue;
    across.push_back({t[0], t[1], t[2]});
    across.push_back({t[0], t[2], t[1]});
    across.push_back({t[1], t[2], t[0]});
  }
  std::sort(across.begin(), across.end());
  first_across_.assign(neighbors_.size() + 1, 0);
  std::size_t at = 0;
  for (std::uint32_t a = 0; a < vertices; ++a) {
    for (std::size_t i = first_[a]; i < first_[a + std::size_t{1}]; ++i) {
      for (; at < across.size() && across[at][0] == a && across[at][1] == neighbors_[i]; ++at) {
        across_.push_back(across[at][2]);
      }
      first_across_[i + 1] = static_cast<std::uint32_t>(across_.size());
    }
  }
}

std::span<const std::uint32_t> PositionGraph::Across(std::uint32_t a, std::uint32_t b) const {
  const auto list = Neighbors(a);
  const auto at = std::lower_bound(list.begin(), list.end(), b);
  if (at == list.end() || *at != b) return {};
  const std::size_t i = first_[a] + static_cast<std::size_t>(at - list.begin());
  return std::span(across_).subspan(first_across_[i], first_across_[i + 1] - first_across_[i]);
}

std::vector<std::uint32_t> PositionGraph::CodingOrder() const {
  std::vector<std::uint32_t> order, count(vertices(), 0);
  std::vector<bool> taken(vertices(), false);
  // queues[k] holds the vertices that have had k neighbours taken, and read[k] is how far it has been read. Of a
  // vertex in several queues the later one comes first, so that it is taken when an earlier one comes to it.
  std::array<std::vector<std::uint32_t>, kMaxCounted + 1> queues;
  std::array<std::size_t, kMaxCounted + 1> read = {};
  std::uint32_t lowest = 0;
  const auto next = [&] {
    for (std::size_t k = kMaxCounted; k > 0; --k) {
      while (read[k] < queues[k].size()) {
        const std::uint32_t v = queues[k][read[k]++];
        if (!taken[v]) return v;
      }
    }
    while (taken[lowest]) ++lowest;
    return lowest;
  };
  while (order.size() < vertices()) {
    const std::uint32_t v = next();
    taken[v] = true;
    order.push_back(v);
    for (const std::uint32_t w : Neighbors(v)) {
      if (taken[w] || count[w] == kMaxCounted) continue;
      queues[++count[w]].push_back(w);
    }
  }
  return order;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/handles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace sac {
namespace {

constexpr std::size_t kFollowed = 8;  // handles that a vertex follows
constexpr std::uint64_t kReach = 3;   // distance, in covering radii, up to which a handle is followed
constexpr std::uint64_t kFewest = 4;  // vertices for each handle, below which every vertex is one
constexpr std::uint64_t kFar = std::numeric_limits<std::uint64_t>::max();

// The largest integer whose square is at most `x`, which is below 2^62.
std::uint64_t Root(std::uint64_t x) {
  auto root = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(x)));
  while (root * root > x) --root;
  while ((root + 1) * (root + 1) <= x) ++root;
  return root;
}

// Visits vertices by ascending distance from one of them (Dijkstra 1959).
class Walk {
 public:
  Walk(const EdgeGraph& graph, std::span<const std::uint32_t> lengths) : graph_(graph), lengths_(lengths) {}

  // Calls visit(v, distance) for `from` and all that lies behind vertices for which visit() returned true. A vertex is
  // visited only when shorten(v, distance) was true, which is asked for each way to it.
  template <class Shorten, class Visit>
  void From(std::uint32_t from, Shorten&& shorten, Visit&& visit) {
    shorten(from, 0);
    queue_.emplace(0, from);
    while (!queue_.empty()) {
      const auto [distance, v] = queue_.top();
      queue_.pop();
      ++steps_;
      if (!visit(v, distance)) continue;
      for (std::uint32_t i = graph_.offsets[v]; i < graph_.offsets[v + 1]; ++i) {
        const std::uint64_t next = distance + lengths_[graph_.edges[i]];
        ++steps_;
        if (shorten(graph_.neighbours[i], next)) queue_.emplace(next, graph_.neighbours[i]);
      }
    }
  }
  // Counts work of the caller among the steps.
  void Count(std::uint32_t steps) { steps_ += steps; }
  double steps() const { return steps_; }

 private:
  using Place = std::pair<std::uint64_t, std::uint32_t>;
  const EdgeGraph& graph_;
  std::span<const std::uint32_t> lengths_;
  std::priority_queue<Place, std::vector<Place>, std::greater<>> queue_;
  double steps_ = 0;
};

// A handle near a vertex.
struct Near {
  std::uint64_t distance;
  std::uint32_t handle;
};

// The handles nearest to each vertex of a component, by distance and number, one more than a vertex follows.
class NearestHandles {
 public:
  explicit NearestHandles(const Component& c) : first_(c.first), lists_(c.count * kHeld), counts_(c.count, 0) {}

  std::span<const Near> Of(std::uint32_t v) const { return {&lists_[(v - first_) * kHeld], counts_[v - first_]}; }
  // Whether a handle with a higher number than all that were added is among the nearest of `v`.
  bool Takes(std::uint32_t v, std::uint64_t distance) const {
    const std::span<const Near> held = Of(v);
    return held.size() < kHeld || distance < held.back().distance;
  }
  void Add(std::uint32_t v, const Near& near) {
    std::uint8_t& count = counts_[v - first_];
    Near* const list = &lists_[(v - first_) * kHeld];
    std::size_t i = count < kHeld ? count++ : kHeld - 1;
    for (; i > 0 && near.distance < list[i - 1].distance; --i) list[i] = list[i - 1];
    list[i] = near;
  }

 private:
  static constexpr std::size_t kHeld = kFollowed + 1;
  std::uint32_t first_;
  std::vector<Near> lists_;
  std::vector<std::uint8_t> counts_;
};

// Chooses the handles of a component by farthest-point sampling: its first vertex, then always the first of those that
// are farthest from all chosen. The first `leaders` lead. Returns the greatest distance of a vertex to the nearest
// handle; `distance` gets that of each vertex of the component. Stops early when more than `max_steps` have been taken.
std::uint64_t ChooseFarthest(const Component& c, std::uint32_t count, std::uint32_t leaders, double max_steps,
                             Walk& walk, std::vector<std::uint64_t>& distance, Handles& handles) {
  const auto first = static_cast<std::uint32_t>(handles.vertices.size());
  std::vector<std::uint32_t> leader(c.count);  // the nearest to each vertex
  const auto begin = distance.begin() + c.first, end = begin + c.count;
  const auto shorten = [&](std::uint32_t v, std::uint64_t d) {
    if (d >= distance[v]) return false;
    distance[v] = d;
    const auto handle = static_cast<std::uint32_t>(handles.vertices.size()) - 1;
    if (handle < first + leaders) leader[v - c.first] = handle;
    return true;
  };
  const auto visit = [&](std::uint32_t v, std::uint64_t d) { return d == distance[v]; };
  std::uint32_t next = c.first;
  for (std::uint32_t i = 0;; ++i) {
    handles.vertices.push_back(next);
    walk.From(next, shorten, visit);
    const auto farthest = std::max_element(begin, end);
    walk.Count(c.count);
    if (i + 1 == count || walk.steps() > max_steps) {
      for (std::size_t h = first; h < handles.vertices.size(); ++h) {
        handles.leaders.push_back(leader[handles.vertices[h] - c.first]);
      }
      return *farthest;
    }
    next = static_cast<std::uint32_t>(farthest - distance.begin());
  }
}

// Ends the list of the handles that the next vertex follows.
void EndVertex(Handles& handles) { handles.offsets.push_back(static_cast<std::uint32_t>(handles.followed.size())); }

// Makes every vertex of a component a handle that it alone follows.
void FollowThemselves(const Component& c, Handles& handles) {
  for (std::uint32_t v = c.first; v < c.first + c.count; ++v) {
    handles.leaders.push_back(static_cast<std::uint32_t>(handles.vertices.size()));
    handles.followed.push_back(static_cast<std::uint32_t>(handles.vertices.size()));
    handles.vertices.push_back(v);
    handles.weights.push_back(1);
    EndVertex(handles);
  }
}

// Appends the handles that `near` holds for the next vertex, with their weights.
void Follow(std::span<const Near> near, std::uint64_t reach, Handles& handles) {
  const std::size_t count = std::min(near.size(), kFollowed);
  const double rho = 1 + static_cast<double>(near.size() > kFollowed ? near[kFollowed].distance : reach);
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = 1 - static_cast<double>(near[i].distance) / rho;
    handles.followed.push_back(near[i].handle);
    handles.weights.push_back(t * t * t);
    sum += t * t * t;
  }
  for (std::size_t i = 0; i < count; ++i) handles.weights[handles.weights.size() - 1 - i] /= sum;
  EndVertex(handles);
}

// Chooses `count` handles of a component, of which the first `leaders` lead, and the weights of its vertices.
// `distance` has kFar for each vertex of the mesh, before and after.
void ChooseAndFollow(const Component& c, std::uint32_t count, std::uint32_t leaders, double max_steps, Walk& walk,
                     std::vector<std::uint64_t>& distance, Handles& handles) {
  auto h = static_cast<std::uint32_t>(handles.vertices.size());
  const std::uint64_t reach = kReach * ChooseFarthest(c, count, leaders, max_steps, walk, distance, handles);
  std::fill_n(distance.begin() + c.first, c.count, kFar);
  NearestHandles nearest(c);
  std::vector<std::uint32_t> reached;  // vertices whose distance is set
  const auto shorten = [&](std::uint32_t v, std::uint64_t d) {
    if (d > reach || d >= distance[v] || !nearest.Takes(v, d)) return false;
    if (distance[v] == kFar) reached.push_back(v);
    distance[v] = d;
    return true;
  };
  for (; h < handles.vertices.size() && walk.steps() <= max_steps; ++h) {
    walk.From(handles.vertices[h], shorten, [&](std::uint32_t v, std::uint64_t d) {
      if (d != distance[v]) return false;  // a shorter way has been taken
      nearest.Add(v, {d, h});
      return true;
    });
    for (const std::uint32_t v : reached) distance[v] = kFar;
    reached.clear();
  }
  for (std::uint32_t v = c.first; v < c.first + c.count; ++v) Follow(nearest.Of(v), reach, handles);
}

}  // namespace

std::uint32_t HandleCount(std::uint32_t vertices, std::uint32_t harmonics, std::uint32_t handles_per_harmonic) {
  const std::uint64_t samples = std::uint64_t{handles_per_harmonic} * harmonics;
  return samples == 0 || kFewest * samples >= vertices ? vertices : static_cast<std::uint32_t>(samples);
}

std::uint32_t LeaderCount(std::uint32_t handles, std::uint32_t harmonics) {
  const std::uint64_t leaders = (std::uint64_t{4} * harmonics + 2) / 3;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(leaders, handles));
}

std::vector<std::uint32_t> EdgeLengths(const EdgeList& edges, std::span<const GridPosition> grid) {
  std::vector<std::uint32_t> lengths;
  lengths.reserve(edges.ends.size());
  for (const auto& [a, b] : edges.ends) {
    std::uint64_t squares = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t d = static_cast<std::int64_t>(grid[a][i]) - grid[b][i];
      squares += static_cast<std::uint64_t>(d * d);
    }
    lengths.push_back(static_cast<std::uint32_t>(std::max<std::uint64_t>(1, Root(4096 * squares))));
  }
  return lengths;
}

Status ChooseHandles(const EdgeGraph& graph, std::span<const std::uint32_t> lengths,
                     std::span<const Component> components, std::span<const std::uint32_t> counts,
                     std::span<const std::uint32_t> leaders, double max_work, Handles& handles) {
  handles = {};
  handles.offsets = {0};
  Walk walk(graph, lengths);
  std::vector<std::uint64_t> distance;
  for (std::size_t i = 0; i < components.size(); ++i) {
    const Component& c = components[i];
    handles.components.push_back({static_cast<std::uint32_t>(handles.vertices.size()), counts[i]});
    if (counts[i] == c.count) {
      FollowThemselves(c, handles);
      continue;
    }
    distance.resize(graph.offsets.size() - 1, kFar);
    ChooseAndFollow(c, counts[i], leaders[i], max_work, walk, distance, handles);
    if (walk.steps() > max_work) return Status::Limit("the handles take more work than the limit");
  }
  return Status::Ok();
}

}  // namespace sac

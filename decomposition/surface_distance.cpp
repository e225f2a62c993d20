// SPDX-License-Identifier: Apache-2.0
#include "decomposition/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <nanoflann.hpp>
#include <queue>
#include <utility>

#include "geometry/components.h"

namespace sac {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The vertices as nanoflann reads them.
struct PointSet {
  const PositionMatrix& points;
  std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(points.rows()); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(axis));
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using PointTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointSet>, PointSet, 3>;

// What a search of the tree fills: the nearest point of another component than `own`.
class NearestOther {
 public:
  NearestOther(const std::vector<std::uint32_t>& labels, std::uint32_t own, double bound)
      : labels_(labels), own_(own), distance_(bound) {}
  std::size_t size() const { return found_ ? 1 : 0; }
  bool full() const { return true; }
  bool addPoint(double distance, std::size_t index) {
    if (labels_[index] != own_ && distance < distance_) {
      distance_ = distance;
      index_ = static_cast<std::uint32_t>(index);
      found_ = true;
    }
    return true;
  }
  double worstDist() const { return distance_; }
  std::uint32_t index() const { return index_; }

 private:
  const std::vector<std::uint32_t>& labels_;
  std::uint32_t own_;
  double distance_;  // squared
  std::uint32_t index_ = 0;
  bool found_ = false;
};

// The distance at the third corner of a triangle, where those at two are known: d0 and d1, at the ends of an edge of
// length e; the third is l0 and l1 from them. The triangle and the source are unfolded in the plane. Where the straight
// line does not cross the edge, the way goes along an edge.
double Unfold(double d0, double d1, double e, double l0, double l1) {
  const double along = std::min(d0 + l0, d1 + l1);
  if (!(e > 0)) return along;
  const double sx = (d0 * d0 - d1 * d1 + e * e) / (2 * e), sy2 = d0 * d0 - sx * sx;
  const double tx = (l0 * l0 - l1 * l1 + e * e) / (2 * e), ty2 = l0 * l0 - tx * tx;
  if (!(sy2 >= 0) || !(ty2 >= 0)) return along;
  const double sy = std::sqrt(sy2), ty = std::sqrt(ty2);
  if (!(sy + ty > 0)) return along;
  const double crossing = sx + (tx - sx) * sy / (sy + ty);
  if (crossing < 0 || crossing > e) return along;
  return std::min(along, std::hypot(tx - sx, sy + ty));
}

}  // namespace

// The front of one call: vertices by their distance so far, the nearest first; ties by number, so that the order is
// the same everywhere.
struct SurfaceDistance::March {
  using Entry = std::pair<double, std::uint32_t>;
  std::vector<double> distance;
  std::vector<char> done;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  double most;

  void Offer(std::uint32_t vertex, double d) {
    if (d < distance[vertex] && d <= most && done[vertex] == 0) {
      distance[vertex] = d;
      front.emplace(d, vertex);
    }
  }
};

SurfaceDistance::SurfaceDistance(const PositionMatrix& positions, std::span<const Triangle> triangles,
                                 bool join_components)
    : positions_(positions), triangles_(triangles.begin(), triangles.end()) {
  BuildIncidence();
  if (join_components) JoinComponents();
}

void SurfaceDistance::BuildIncidence() {
  first_.assign(static_cast<std::size_t>(positions_.rows()) + 1, 0);
  lengths_.resize(triangles_.size());
  for (std::size_t j = 0; j < triangles_.size(); ++j) {
    const Triangle& t = triangles_[j];
    for (std::size_t k = 0; k < 3; ++k) {
      ++first_[t[k] + 1];
      lengths_[j][k] = (positions_.row(t[(k + 1) % 3]) - positions_.row(t[(k + 2) % 3])).norm();
    }
  }
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  around_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t j = 0; j < triangles_.size(); ++j) {
    for (const std::uint32_t v : triangles_[j]) around_[next[v]++] = static_cast<std::uint32_t>(j);
  }
}

void SurfaceDistance::JoinComponents() {
  const auto vertices = static_cast<std::uint32_t>(positions_.rows());
  std::uint32_t count = 0;
  std::vector<std::uint32_t> labels = LabelComponents(vertices, triangles_, count);
  if (count <= 1) return;
  lines_.resize(vertices);
  const PointSet points{positions_};
  PointTree tree(3, points);
  tree.buildIndex();
  while (count > 1) {
    struct Shortest {
      double distance = kInfinity;
      std::uint32_t from = 0, to = 0;
    };
    std::vector<Shortest> shortest(count);
    for (std::uint32_t v = 0; v < vertices; ++v) {
      Shortest& best = shortest[labels[v]];
      NearestOther nearest(labels, labels[v], best.distance);
      const double at[3] = {positions_(v, 0), positions_(v, 1), positions_(v, 2)};
      tree.findNeighbors(nearest, at, nanoflann::SearchParams());
      if (nearest.size() > 0) best = {nearest.worstDist(), v, nearest.index()};
    }
    // Components that a line joins get the number of the lower one; chains are followed to their end.
    std::vector<std::uint32_t> parent(count);
    for (std::uint32_t c = 0; c < count; ++c) parent[c] = c;
    const auto root = [&parent](std::uint32_t c) {
      while (parent[c] != c) c = parent[c] = parent[parent[c]];
      return c;
    };
    for (const Shortest& s : shortest) {
      const std::uint32_t a = root(labels[s.from]), b = root(labels[s.to]);
      if (a == b) continue;  // the other one chose the same line, or as short a one
      parent[std::max(a, b)] = std::min(a, b);
      const double length = std::sqrt(s.distance);
      lines_[s.from].push_back({s.to, length});
      lines_[s.to].push_back({s.from, length});
    }
    std::vector<std::uint32_t> number(count);
    std::uint32_t left = 0;
    for (std::uint32_t c = 0; c < count; ++c) {
      if (parent[c] == c) number[c] = left++;
    }
    for (std::uint32_t& label : labels) label = number[root(label)];
    count = left;
  }
}

void SurfaceDistance::Across(std::uint32_t triangle, std::uint32_t vertex, March& march) const {
  const Triangle& t = triangles_[triangle];
  const auto& length = lengths_[triangle];
  const std::size_t k = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2, a = (k + 1) % 3, b = (k + 2) % 3;
  const double d = march.distance[vertex];
  const auto update = [&](std::size_t target, std::size_t other) {
    const double offered = march.done[t[other]] != 0
                               ? Unfold(d, march.distance[t[other]], length[target], length[other], length[k])
                               : d + length[other];
    march.Offer(t[target], offered);
  };
  if (march.done[t[a]] == 0) update(a, b);
  if (march.done[t[b]] == 0) update(b, a);
}

std::vector<double> SurfaceDistance::From(std::span<const Seed> seeds, double most) const {
  const auto vertices = static_cast<std::size_t>(positions_.rows());
  March march{std::vector<double>(vertices, kInfinity), std::vector<char>(vertices, 0), {}, most};
  for (const Seed& seed : seeds) march.Offer(seed.vertex, seed.distance);
  while (!march.front.empty()) {
    const auto [d, v] = march.front.top();
    march.front.pop();
    if (march.done[v] != 0) continue;
    march.done[v] = 1;
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) Across(around_[i], v, march);
    if (lines_.empty()) continue;
    for (const Line& line : lines_[v]) march.Offer(line.to, d + line.length);
  }
  return std::move(march.distance);
}

std::vector<double> SurfaceDistance::FromTriangles(std::span<const std::uint32_t> from, double most) const {
  std::vector<Seed> seeds;
  for (const std::uint32_t j : from) {
    const Triangle& t = triangles_[j];
    const Eigen::RowVector3d centroid = (positions_.row(t[0]) + positions_.row(t[1]) + positions_.row(t[2])) / 3;
    for (const std::uint32_t v : t) seeds.push_back({v, (positions_.row(v) - centroid).norm()});
  }
  const std::vector<double> at = From(seeds, most);
  std::vector<double> distances(triangles_.size());
  for (std::size_t j = 0; j < triangles_.size(); ++j) {
    const Triangle& t = triangles_[j];
    distances[j] = (at[t[0]] + at[t[1]] + at[t[2]]) / 3;
  }
  return distances;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "sac/mesh.h"

namespace sac {

inline double SquaredDistance(const Vec3f& a, const Vec3f& b) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double d = static_cast<double>(a[k]) - static_cast<double>(b[k]);
    sum += d * d;
  }
  return sum;
}

// One of two meshes that are to be matched: its adjacency, and colors of vertices that do not depend on their order.
// A corner is 3 * triangle + k; it is also the edge from corner k of the triangle to the next.
class MatchSide {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  // `mesh` must outlive this, and have less than 2^32 - 1 corners. `axis`, the same for both sides, is the one along
  // which triangles are sorted.
  MatchSide(const Mesh& mesh, std::size_t axis);

  const Vec3f& position(std::uint32_t vertex) const { return mesh_.positions[vertex]; }
  const Triangle& triangle(std::uint32_t t) const { return mesh_.triangles[t]; }
  std::span<const std::uint32_t> corners(std::uint32_t vertex) const {
    return std::span(corners_).subspan(begins_[vertex], begins_[vertex + 1] - begins_[vertex]);
  }
  // The same edge in the triangle on the other side; kNone unless exactly two triangles have it, in opposite
  // directions.
  std::uint32_t twin(std::uint32_t corner) const { return twins_[corner]; }
  // A hash of what is around a vertex, up to some edges away.
  std::uint64_t color(std::uint32_t vertex) const { return colors_[vertex]; }
  // A hash of the colors of a triangle's corners, the same for its rotations.
  std::uint64_t kind(std::uint32_t t) const { return kinds_[t]; }
  // The coordinate of a vertex along the axis, and that of a triangle's center.
  double along(std::uint32_t vertex) const { return static_cast<double>(mesh_.positions[vertex][axis_]); }
  double middle(std::uint32_t t) const { return static_cast<double>(centers_[t][axis_]); }
  const Vec3f& center(std::uint32_t t) const { return centers_[t]; }

  // The triangles of a kind, by middle().
  std::span<const std::uint32_t> TrianglesLike(std::uint64_t kind) const;
  // All triangles, those first whose kind has the fewest.
  std::vector<std::uint32_t> RarestFirst() const;

 private:
  void FindCorners();
  void FindTwins();
  void Refine();
  void SortKinds();

  const Mesh& mesh_;
  std::size_t axis_;
  std::vector<std::uint32_t> begins_, corners_, twins_;
  std::vector<std::uint64_t> colors_, kinds_;
  Positions centers_;                   // of triangles
  std::vector<std::uint32_t> by_kind_;  // triangles
};

}  // namespace sac

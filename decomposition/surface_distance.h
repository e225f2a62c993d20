// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/laplacian.h"
#include "sac/mesh.h"

namespace sac {

// Distances along a surface by fast marching (Kimmel and Sethian 1998): a vertex whose distance is known updates across
// each of its triangles, by unfolding the triangle in the plane. It needs no factorization and asks nothing of the
// triangles; degenerate ones and borders are fine.
class SurfaceDistance {
 public:
  // A vertex that the distance is measured from, and the distance that it has itself, model units.
  struct Seed {
    std::uint32_t vertex;
    double distance;
  };

  // `positions` has one row a vertex, model units; every index of `triangles` is below their number. With
  // `join_components` each connected component is joined to the nearest other one by the shortest line between their
  // vertices, again and again until there is one, so that eyes and teeth follow the face; without, the distance from
  // one component to another is infinite.
  SurfaceDistance(const PositionMatrix& positions, std::span<const Triangle> triangles, bool join_components = true);

  // The distance of each vertex from the nearest of `seeds`, model units; infinite beyond `most`. May be called from
  // several threads at once.
  std::vector<double> From(std::span<const Seed> seeds, double most) const;

  // The same at triangles, from a set of triangles: a triangle's distance is the mean of its corners', and a triangle
  // of the set is left from its centroid.
  std::vector<double> FromTriangles(std::span<const std::uint32_t> from, double most) const;

 private:
  struct Line {
    std::uint32_t to;
    double length;
  };
  struct March;

  void BuildIncidence();
  void JoinComponents();
  void Across(std::uint32_t triangle, std::uint32_t vertex, March& march) const;

  PositionMatrix positions_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<double, 3>> lengths_;  // of the edge opposite each corner
  std::vector<std::uint32_t> first_, around_;   // the triangles around vertex v: around_[first_[v]] ...
  std::vector<std::vector<Line>> lines_;        // between connected components, per vertex; empty if there are none
};

}  // namespace sac

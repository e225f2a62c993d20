// SPDX-License-Identifier: Apache-2.0
#include "files/cache_match.h"

#include <algorithm>
#include <cmath>

namespace sac {
namespace {

constexpr std::size_t kFewestTriangles = 8;
constexpr double kManyTimes = 3;

double Distance(const Vec3f& a, const Vec3f& b) {
  return std::hypot(static_cast<double>(a[0]) - b[0], static_cast<double>(a[1]) - b[1],
                    static_cast<double>(a[2]) - b[2]);
}

template <typename T>
T Median(std::vector<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The median length of the triangles' edges over the median distance of vertices from the middle of all; both medians,
// because some vertices may be parked far away. Not a number if the positions are not finite.
double RelativeEdge(const std::vector<Triangle>& triangles, const Positions& positions) {
  Vec3f middle{};
  for (int k = 0; k < 3; ++k) {
    std::vector<float> coordinates;
    for (const Vec3f& p : positions) {
      if (!std::isfinite(p[k])) return std::nan("");
      coordinates.push_back(p[k]);
    }
    middle[k] = Median(std::move(coordinates));
  }
  std::vector<double> edges, distances;
  for (const auto& [a, b, c] : triangles) {
    for (const double length : {Distance(positions[a], positions[b]), Distance(positions[b], positions[c]),
                                Distance(positions[c], positions[a])}) {
      edges.push_back(length);
    }
  }
  for (const Vec3f& p : positions) distances.push_back(Distance(p, middle));
  return Median(std::move(edges)) / Median(std::move(distances));
}

}  // namespace

bool IsLikelyInAnotherOrder(const Mesh& mesh, const Positions& frame) {
  if (mesh.triangles.size() < kFewestTriangles) return false;
  const double expected = RelativeEdge(mesh.triangles, mesh.positions);
  const double found = RelativeEdge(mesh.triangles, frame);
  return expected > 0 && std::isfinite(expected) && std::isfinite(found) && found > kManyTimes * expected;
}

}  // namespace sac

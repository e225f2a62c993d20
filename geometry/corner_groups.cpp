// SPDX-License-Identifier: Apache-2.0
#include "geometry/corner_groups.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <tuple>
#include <utility>

namespace sac {
namespace {

std::uint32_t At(const std::vector<Triangle>& triangles, std::size_t corner) {
  return triangles[corner / 3][corner % 3];
}

// Whether all corners of each vertex have one class.
bool Agree(const std::vector<Triangle>& triangles, std::size_t vertices, const std::vector<Triangle>& classes) {
  std::vector<std::uint32_t> of_vertex(vertices);
  std::vector<bool> seen(vertices);
  for (std::size_t j = 0; j < triangles.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = triangles[j][k];
      if (seen[v] && of_vertex[v] != classes[j][k]) return false;
      seen[v] = true;
      of_vertex[v] = classes[j][k];
    }
  }
  return true;
}

}  // namespace

CornerGroups GroupCorners(const std::vector<Triangle>& vertices, const std::vector<Triangle>& classes) {
  // By sorting: a list for each vertex would be searched in quadratic time where all triangles meet at one.
  std::vector<std::size_t> order(3 * vertices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto pair = [&](std::size_t c) { return std::pair(At(vertices, c), At(classes, c)); };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::tuple(pair(a), a) < std::tuple(pair(b), b); });
  std::vector<std::size_t> leader(order.size());  // per corner the first one of its group
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool begins = i == 0 || pair(order[i]) != pair(order[i - 1]);
    leader[order[i]] = begins ? order[i] : leader[order[i - 1]];
  }
  CornerGroups groups;
  groups.triangles.resize(vertices.size());
  for (std::size_t c = 0; c < leader.size(); ++c) {
    std::uint32_t& group = groups.triangles[c / 3][c % 3];
    if (leader[c] == c) {
      group = static_cast<std::uint32_t>(groups.first.size());
      groups.first.push_back(c);
    } else {
      group = At(groups.triangles, leader[c]);
    }
  }
  return groups;
}

std::vector<std::uint32_t> ClassesByBits(const std::vector<Vec3f>& normals) {
  using Bits = std::array<std::uint32_t, 3>;
  const auto bits = [&](std::uint32_t i) { return std::bit_cast<Bits>(normals[i]); };
  std::vector<std::uint32_t> order(normals.size()), classes(normals.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return bits(a) < bits(b); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    classes[order[i]] = classes[order[i - 1]] + (bits(order[i]) == bits(order[i - 1]) ? 0 : 1);
  }
  return classes;
}

void MergeNormals(const std::vector<Triangle>& triangles, std::size_t vertices,
                  const std::vector<std::uint32_t>& classes, const std::vector<Vec3f>& loose,
                  std::vector<Vec3f>& normals, std::vector<Triangle>& normal_triangles) {
  std::vector<Triangle> class_of_corner = normal_triangles;
  for (Triangle& t : class_of_corner) {
    for (std::uint32_t& i : t) i = classes[i];
  }
  std::vector<Vec3f> merged;
  if (Agree(triangles, vertices, class_of_corner)) {
    merged = loose;
    merged.resize(vertices);
    for (std::size_t c = 3 * triangles.size(); c-- > 0;) {  // the first corner comes last, and stays
      merged[At(triangles, c)] = normals[At(normal_triangles, c)];
    }
    normal_triangles.clear();
  } else {
    CornerGroups groups = GroupCorners(triangles, class_of_corner);
    for (const std::size_t c : groups.first) merged.push_back(normals[At(normal_triangles, c)]);
    normal_triangles = std::move(groups.triangles);
  }
  normals = std::move(merged);
}

}  // namespace sac

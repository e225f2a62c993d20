// SPDX-License-Identifier: Apache-2.0
#include "geometry/surface_unwrapping.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <numeric>
#include <queue>
#include <tuple>

#include "geometry/edges.h"

namespace sac {

namespace {

Eigen::Vector3d NearestTurn(const Eigen::Vector3d& vector, const Eigen::Vector3d& previous) {
  const double angle = vector.norm();
  return sac::NearestTurn(angle > 0 ? Eigen::Vector3d(vector / angle) : vector, angle, previous);
}

}  // namespace

Eigen::Vector3d NearestTurn(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& previous) {
  constexpr double kTurn = 2 * std::numbers::pi;
  if (angle < 1e-9) {  // no axis of its own: whole turns about the previous one
    const double turns = std::round(previous.norm() / kTurn);
    return turns == 0 ? Eigen::Vector3d(angle * axis) : Eigen::Vector3d(previous.normalized() * turns * kTurn);
  }
  return axis * (angle + std::round((previous.dot(axis) - angle) / kTurn) * kTurn);
}

SurfaceUnwrapping::SurfaceUnwrapping(std::span<const Triangle> triangles) {
  const EdgeList edges = BuildEdges(triangles);
  std::vector<std::uint32_t> first(edges.ends.size() + 1);  // in `around`, of each edge
  for (const auto& of_triangle : edges.of_triangle) {
    for (const std::uint32_t e : of_triangle) {
      if (e != EdgeList::kNone) ++first[e + 1];
    }
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> around(first.back()), next(first.begin(), first.end() - 1);
  for (std::uint32_t j = 0; j < triangles.size(); ++j) {
    for (const std::uint32_t e : edges.of_triangle[j]) {
      if (e != EdgeList::kNone) around[next[e]++] = j;
    }
  }
  offsets_.push_back(0);
  for (std::uint32_t j = 0; j < triangles.size(); ++j) {
    for (const std::uint32_t e : edges.of_triangle[j]) {
      if (e == EdgeList::kNone) continue;
      // Where many triangles share an edge, the next one of them is enough: the others follow from it.
      for (std::uint32_t i = first[e]; i < first[e + 1]; ++i) {
        if (around[i] != j) continue;
        if (i > first[e]) neighbours_.push_back(around[i - 1]);
        if (i + 1 < first[e + 1]) neighbours_.push_back(around[i + 1]);
      }
    }
    offsets_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
  }
}

void SurfaceUnwrapping::Unwrap(std::span<const std::uint8_t> left_out, Eigen::Ref<Eigen::MatrixXd> vectors) const {
  const auto vector = [&](std::uint32_t j) -> Eigen::Vector3d {
    return vectors.row(static_cast<Eigen::Index>(j)).head<3>();
  };
  std::vector<std::uint8_t> done(left_out.begin(), left_out.end());
  // By distance, so that a triangle follows the neighbour that it agrees with best; numbers settle what is equal.
  using Step = std::tuple<double, std::uint32_t, std::uint32_t>;  // distance, to, from
  std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
  const auto finish = [&](std::uint32_t j) {
    done[j] = 1;
    for (std::uint32_t i = offsets_[j]; i < offsets_[j + 1]; ++i) {
      const std::uint32_t to = neighbours_[i];
      if (done[to] == 0) steps.emplace((NearestTurn(vector(to), vector(j)) - vector(j)).norm(), to, j);
    }
  };
  std::vector<std::uint32_t> seeds(left_out.size());
  std::iota(seeds.begin(), seeds.end(), 0);
  std::stable_sort(seeds.begin(), seeds.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return vector(a).squaredNorm() < vector(b).squaredNorm(); });
  for (const std::uint32_t seed : seeds) {
    if (done[seed] != 0) continue;
    finish(seed);
    while (!steps.empty()) {
      const auto [distance, to, from] = steps.top();
      steps.pop();
      if (done[to] != 0) continue;
      vectors.row(static_cast<Eigen::Index>(to)) = NearestTurn(vector(to), vector(from)).transpose();
      finish(to);
    }
  }
}

}  // namespace sac

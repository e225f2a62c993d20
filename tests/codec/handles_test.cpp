// SPDX-License-Identifier: Apache-2.0
#include "codec/handles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "geometry/edges.h"
#include "tests/test_meshes.h"

namespace sac {
namespace {

constexpr std::uint64_t kFar = std::numeric_limits<std::uint64_t>::max() / 2;

// A mesh on a grid whose components are runs of vertices.
struct Setting {
  explicit Setting(const Mesh& mesh) {
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3f& p : mesh.positions) {
      GridPosition& g = grid.emplace_back();
      for (std::size_t a = 0; a < 3; ++a) g[a] = static_cast<std::uint32_t>(std::lround(1000 * (p[a] + 10)));
    }
    edges = BuildEdges(mesh.triangles);
    graph = BuildEdgeGraph(n, edges);
    lengths = EdgeLengths(edges, grid);
    std::uint32_t count = 0;
    const auto labels = LabelComponents(n, mesh.triangles, count);
    components.resize(count, {0, 0});
    for (std::uint32_t v = 0; v < n; ++v) {
      if (components[labels[v]].count++ == 0) components[labels[v]].first = v;
    }
  }

  Handles Choose(const std::vector<std::uint32_t>& counts) const {
    Handles handles;
    EXPECT_TRUE(ChooseHandles(graph, lengths, components, counts, counts, 1e9, handles).ok());
    return handles;
  }

  // The distances along edges from `from`, by relaxing all edges until nothing changes.
  std::vector<std::uint64_t> Distances(std::uint32_t from) const {
    std::vector<std::uint64_t> distance(grid.size(), kFar);
    distance[from] = 0;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t e = 0; e < edges.ends.size(); ++e) {
        const auto [a, b] = edges.ends[e];
        const std::uint64_t to_a = distance[b] + lengths[e], to_b = distance[a] + lengths[e];
        if (to_a < distance[a]) distance[a] = to_a, changed = true;
        if (to_b < distance[b]) distance[b] = to_b, changed = true;
      }
    }
    return distance;
  }

  std::vector<GridPosition> grid;
  EdgeList edges;
  EdgeGraph graph;
  std::vector<std::uint32_t> lengths;
  std::vector<Component> components;
};

TEST(Handles, LengthsAreRootsRoundedDown) {
  EdgeList edges;
  edges.ends = {{0, 1}, {1, 2}, {0, 2}};
  const std::vector<GridPosition> grid = {{0, 0, 0}, {1, 1, 1}, {(1u << 24) - 1, (1u << 24) - 1, (1u << 24) - 1}};
  const auto lengths = EdgeLengths(edges, grid);
  EXPECT_EQ(lengths[0], 110u);  // 64 sqrt(3) = 110.85
  EXPECT_EQ(lengths[2], 1859775282u);
  EXPECT_EQ(EdgeLengths(edges, {{{5, 5, 5}, {5, 5, 5}, {5, 5, 5}}})[0], 1u);
}

TEST(Handles, AreAllVerticesUnlessThereAreFourTimesAsMany) {
  EXPECT_EQ(HandleCount(800, 100, 2), 800u);
  EXPECT_EQ(HandleCount(801, 100, 2), 200u);
  EXPECT_EQ(HandleCount(4'000'000, 100, 0), 4'000'000u);
  EXPECT_EQ(HandleCount(1000, 0xffffffffu, 0xffffffffu), 1000u);
}

// Against the definition of spec.md 6.4.4, evaluated one distance at a time.
TEST(Handles, AreTheFarthestAndWeighByDistance) {
  const Setting s(PartsMesh());  // 92 and 56 vertices, a tetrahedron, a point
  const Handles handles = s.Choose({20, 3, 4, 1});
  ASSERT_EQ(handles.vertices.size(), 28u);
  for (std::size_t c = 0; c < 2; ++c) {
    const Component &run = handles.components[c], &vertices = s.components[c];
    EXPECT_EQ(handles.vertices[run.first], vertices.first);
    std::vector<std::vector<std::uint64_t>> from;
    std::uint64_t covering = 0;
    for (std::uint32_t i = 0; i < run.count; ++i) {
      from.push_back(s.Distances(handles.vertices[run.first + i]));
      std::uint32_t farthest = vertices.first;
      const auto nearest = [&](std::uint32_t v) {
        std::uint64_t least = kFar;
        for (const auto& d : from) least = std::min(least, d[v]);
        return least;
      };
      for (std::uint32_t v = vertices.first; v < vertices.first + vertices.count; ++v) {
        if (nearest(v) > nearest(farthest)) farthest = v;
      }
      if (i + 1 < run.count) {
        EXPECT_EQ(handles.vertices[run.first + i + 1], farthest);
      }
      covering = nearest(farthest);
    }
    for (std::uint32_t v = vertices.first; v < vertices.first + vertices.count; ++v) {
      std::vector<std::pair<std::uint64_t, std::uint32_t>> near;
      for (std::uint32_t i = 0; i < run.count; ++i) {
        if (from[i][v] <= 3 * covering) near.emplace_back(from[i][v], run.first + i);
      }
      std::sort(near.begin(), near.end());
      const double rho = 1.0 + static_cast<double>(near.size() > 8 ? near[8].first : 3 * covering);
      near.resize(std::min<std::size_t>(near.size(), 8));
      double sum = 0;
      for (const auto& [d, h] : near) sum += std::pow(1 - static_cast<double>(d) / rho, 3);
      const auto followed = handles.FollowedBy(v);
      ASSERT_EQ(followed.size(), near.size());
      for (std::size_t i = 0; i < near.size(); ++i) {
        EXPECT_EQ(followed[i], near[i].second);
        EXPECT_NEAR(handles.WeightsOf(v)[i], std::pow(1 - static_cast<double>(near[i].first) / rho, 3) / sum, 1e-15);
      }
    }
  }
  for (std::uint32_t v = s.components[2].first; v < s.grid.size(); ++v) {
    ASSERT_EQ(handles.FollowedBy(v).size(), 1u);
    EXPECT_EQ(handles.vertices[handles.FollowedBy(v)[0]], v);
    EXPECT_EQ(handles.WeightsOf(v)[0], 1.0);
  }
}

TEST(Handles, OfCoincidentVerticesAreChosenByNumber) {
  Mesh mesh = TubeMesh(5, 40);
  for (Vec3f& p : mesh.positions) p = {0, 0, 0};
  const Setting s(mesh);
  const Handles handles = s.Choose({10});
  for (std::uint32_t v = 0; v < s.grid.size(); ++v) {
    double sum = 0;
    for (std::size_t i = 0; i < handles.FollowedBy(v).size(); ++i) sum += handles.WeightsOf(v)[i];
    EXPECT_NEAR(sum, 1, 1e-15);
  }
}

TEST(Handles, StopAtTheirLimitOfWork) {
  const Setting s(SphereMesh(20));
  Handles handles;
  const Status status = ChooseHandles(s.graph, s.lengths, s.components, std::vector<std::uint32_t>{100},
                                      std::vector<std::uint32_t>{50}, 1e4, handles);
  EXPECT_EQ(status.code(), StatusCode::kLimit);
}

}  // namespace
}  // namespace sac

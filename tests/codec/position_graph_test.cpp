// SPDX-License-Identifier: Apache-2.0
#include "codec/position_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace sac {
namespace {

using List = std::vector<std::uint32_t>;

List ToList(std::span<const std::uint32_t> s) { return {s.begin(), s.end()}; }

TEST(PositionGraph, NeighborsAndWhatIsAcross) {
  // A square 0 1 2 3 cut along 0-2, a third triangle on the same edge, one of them twice and turned.
  const std::vector<Triangle> triangles = {{0, 1, 2}, {2, 3, 0}, {0, 2, 4}, {2, 0, 1}};
  const PositionGraph graph(5, triangles);
  EXPECT_EQ(ToList(graph.Neighbors(0)), List({1, 2, 3, 4}));
  EXPECT_EQ(ToList(graph.Neighbors(1)), List({0, 2}));
  EXPECT_EQ(ToList(graph.Across(0, 2)), List({1, 3, 4}));
  EXPECT_EQ(ToList(graph.Across(0, 1)), List({2}));
  EXPECT_TRUE(graph.Across(1, 3).empty());
}

TEST(PositionGraph, DegenerateTrianglesHaveEdgesButNothingAcross) {
  const PositionGraph graph(3, std::vector<Triangle>{{0, 0, 1}, {2, 2, 2}});
  EXPECT_EQ(ToList(graph.Neighbors(0)), List({1}));
  EXPECT_TRUE(graph.Across(0, 1).empty());
  EXPECT_TRUE(graph.Neighbors(2).empty());
}

TEST(PositionGraph, LeavesOutHubs) {
  for (const std::uint32_t spokes : {32u, 33u}) {
    std::vector<Triangle> fan;
    for (std::uint32_t i = 0; i < spokes; ++i) fan.push_back({0, 1 + i, 1 + (i + 1) % spokes});
    const PositionGraph graph(spokes + 1, fan);
    EXPECT_EQ(graph.Neighbors(0).size(), spokes == 32 ? 32u : 0u);
    EXPECT_EQ(graph.Neighbors(1).size(), spokes == 32 ? 3u : 2u);
    EXPECT_EQ(ToList(graph.Across(1, 2)), spokes == 32 ? List({0}) : List());
  }
}

TEST(PositionGraph, OrderTakesWhatHasMostNeighbors) {
  // A strip 0-1-2-3-4-5 of triangles: each has two neighbours before it when its turn comes.
  const PositionGraph strip(6, std::vector<Triangle>{{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 5}});
  EXPECT_EQ(strip.CodingOrder(), List({0, 1, 2, 3, 4, 5}));
  // The same numbered from the far end: 0's neighbours queue in ascending order.
  const PositionGraph turned(6, std::vector<Triangle>{{0, 5, 4}, {5, 4, 3}, {4, 3, 2}, {3, 2, 1}});
  EXPECT_EQ(turned.CodingOrder(), List({0, 4, 5, 3, 2, 1}));
  // Components follow each other.
  const PositionGraph two(7, std::vector<Triangle>{{0, 2, 4}, {1, 3, 5}});
  EXPECT_EQ(two.CodingOrder(), List({0, 2, 4, 1, 3, 5, 6}));
}

TEST(PositionGraph, OrderHasEveryVertexOnce) {
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < 300; ++i) triangles.push_back({i * 7 % 97, i * 31 % 97, i * i % 97});
  List order = PositionGraph(100, triangles).CodingOrder();
  List all(100);
  std::iota(all.begin(), all.end(), 0u);
  std::sort(order.begin(), order.end());
  EXPECT_EQ(order, all);
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "geometry/components.h"
#include "tests/test_meshes.h"

namespace sac {
namespace {

std::vector<GridPosition> Grid(const Mesh& mesh) {
  std::vector<GridPosition> grid;
  for (const Vec3f& p : mesh.positions) {
    GridPosition& g = grid.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) g[a] = static_cast<std::uint32_t>(std::lround(100 * (p[a] + 10)));
  }
  return grid;
}

std::vector<std::uint32_t> All(const Mesh& mesh) {
  std::vector<std::uint32_t> vertices(mesh.positions.size());
  std::iota(vertices.begin(), vertices.end(), 0u);
  return vertices;
}

TEST(VertexGraph, HoldsEveryEdgeBothWays) {
  const std::vector<Triangle> triangles = {{0, 1, 2}, {2, 1, 3}, {5, 5, 0}};
  const VertexGraph graph = BuildGraph(7, triangles);
  ASSERT_EQ(graph.offsets.size(), 8u);
  const auto neighbours = [&](std::uint32_t v) {
    return std::set<std::uint32_t>(graph.neighbours.begin() + graph.offsets[v],
                                   graph.neighbours.begin() + graph.offsets[v + 1]);
  };
  EXPECT_EQ(neighbours(1), (std::set<std::uint32_t>{0, 2, 3}));
  EXPECT_EQ(neighbours(3), (std::set<std::uint32_t>{1, 2}));
  EXPECT_TRUE(neighbours(0).contains(5));
  EXPECT_TRUE(neighbours(5).contains(0));
  EXPECT_TRUE(neighbours(4).empty());
}

TEST(Patches, AreSmallConnectedAndComplete) {
  for (const Mesh& mesh : {SphereMesh(6), TubeMesh(30, 9), TubeMesh(2, 3)}) {
    const VertexGraph graph = BuildGraph(static_cast<std::uint32_t>(mesh.positions.size()), mesh.triangles);
    for (const std::uint32_t size : {1u, 2u, 17u, 64u, 100000u}) {
      const PatchOrder order = CutIntoPatches(Grid(mesh), graph, All(mesh), size);
      std::vector<std::uint32_t> sorted = order.vertices;
      std::sort(sorted.begin(), sorted.end());
      EXPECT_EQ(sorted, All(mesh));
      EXPECT_EQ(std::accumulate(order.sizes.begin(), order.sizes.end(), std::size_t{0}), mesh.positions.size());
      std::size_t first = 0;
      for (const std::uint32_t count : order.sizes) {
        ASSERT_GE(count, 1u);
        EXPECT_LE(count, size);
        // Connected by triangles' edges within the patch.
        std::vector<std::uint32_t> index(mesh.positions.size(), count);
        for (std::uint32_t i = 0; i < count; ++i) index[order.vertices[first + i]] = i;
        std::vector<Triangle> inside;
        for (const Triangle& t : mesh.triangles) {
          for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = index[t[k]], b = index[t[(k + 1) % 3]];
            if (a < count && b < count) inside.push_back({a, b, b});
          }
        }
        std::uint32_t components = 0;
        LabelComponents(count, inside, components);
        EXPECT_EQ(components, 1u);
        first += count;
      }
      // Halving leaves patches at least half full, but for pieces that fall apart.
      if (size == 64) {
        EXPECT_LE(order.sizes.size(), 2 + 4 * mesh.positions.size() / size);
      }
    }
  }
}

TEST(Patches, DoNotDependOnTheOrderOfVertices) {
  const Mesh mesh = SphereMesh(5);
  const VertexGraph graph = BuildGraph(static_cast<std::uint32_t>(mesh.positions.size()), mesh.triangles);
  std::vector<std::uint32_t> shuffled = All(mesh);
  std::mt19937 random(1);
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  const PatchOrder a = CutIntoPatches(Grid(mesh), graph, All(mesh), 20);
  const PatchOrder b = CutIntoPatches(Grid(mesh), graph, shuffled, 20);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.sizes, b.sizes);
}

TEST(Patches, OfCoincidentVerticesAreCutByIndex) {
  const Mesh mesh = TubeMesh(6, 6);
  const VertexGraph graph = BuildGraph(36, mesh.triangles);
  const PatchOrder order = CutIntoPatches(std::vector<GridPosition>(36, {5, 5, 5}), graph, All(mesh), 18);
  EXPECT_EQ(order.vertices, All(mesh));
  EXPECT_EQ(order.sizes, (std::vector<std::uint32_t>{18, 18}));
}

}  // namespace
}  // namespace sac

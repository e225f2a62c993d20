// SPDX-License-Identifier: Apache-2.0
#include "geometry/corner_groups.h"

#include <gtest/gtest.h>

#include "tests/hard_cube.h"

namespace sac {
namespace {

TEST(CornerGroups, AreNumberedByFirstCorners) {
  const std::vector<Triangle> vertices = {{5, 0, 1}, {1, 0, 5}, {5, 5, 5}};
  const std::vector<Triangle> classes = {{9, 9, 2}, {3, 9, 9}, {9, 1, 1}};
  const CornerGroups groups = GroupCorners(vertices, classes);
  EXPECT_EQ(groups.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 1, 0}, {0, 4, 4}}));
  EXPECT_EQ(groups.first, (std::vector<std::size_t>{0, 1, 2, 3, 7}));
  EXPECT_TRUE(GroupCorners({}, {}).triangles.empty());
}

// A vertex of as many triangles as there are, each with a class of its own, takes no quadratic time.
TEST(CornerGroups, OneVertexOfAllTriangles) {
  constexpr std::uint32_t kTriangles = 400'000;
  std::vector<Triangle> vertices, classes;
  for (std::uint32_t j = 0; j < kTriangles; ++j) {
    vertices.push_back({0, 0, 0});
    classes.push_back({3 * j, 3 * j + 1, 3 * j + 2});
  }
  const CornerGroups groups = GroupCorners(vertices, classes);
  EXPECT_EQ(groups.triangles, classes);
}

TEST(MergeNormals, BecomeThoseOfVerticesWhereCornersAgree) {
  const std::vector<Triangle> triangles = {{0, 1, 2}, {2, 1, 3}};
  std::vector<Vec3f> normals = {{0, 0, 1}, {0, 1, 0}, {0, 1, 1e-9f}, {1, 0, 0}};
  std::vector<Triangle> corners = {{0, 1, 3}, {3, 2, 0}};
  const std::vector<Vec3f> loose = {{9, 9, 9}, {9, 9, 9}, {9, 9, 9}, {9, 9, 9}, {0, 0, 5}};
  MergeNormals(triangles, 5, {0, 1, 1, 2}, loose, normals, corners);
  EXPECT_TRUE(corners.empty());
  EXPECT_EQ(normals, (std::vector<Vec3f>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 5}}));
}

TEST(MergeNormals, ACubeHas24) {
  Mesh cube = HardCubeMesh();
  const std::vector<Vec3f> faces = cube.normals;
  MergeNormals(cube.triangles, 8, {0, 1, 2, 3, 4, 5}, {}, cube.normals, cube.normal_triangles);
  ASSERT_EQ(cube.normals.size(), 24u);
  for (std::size_t j = 0; j < 12; ++j) {
    for (const std::uint32_t i : cube.normal_triangles[j]) EXPECT_EQ(cube.normals[i], faces[j / 2]);
  }
}

}  // namespace
}  // namespace sac

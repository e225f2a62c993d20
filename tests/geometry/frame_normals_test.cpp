// SPDX-License-Identifier: Apache-2.0
#include "sac/frame_normals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/normals.h"
#include "tests/hard_cube.h"
#include "tests/test_meshes.h"

namespace sac {
namespace {

Eigen::Vector3d ToVector(const Vec3f& v) { return {v[0], v[1], v[2]}; }

// The largest distance of a normal to the one with `turn` of the reference's.
double Apart(const std::vector<Vec3f>& normals, const std::vector<Vec3f>& reference, const Eigen::Matrix3d& turn) {
  EXPECT_EQ(normals.size(), reference.size());
  double apart = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    apart = std::max(apart, (ToVector(normals[i]) - turn * ToVector(reference[i])).norm());
  }
  return apart;
}

TEST(FrameNormals, NoneWithoutAny) {
  const Mesh mesh = SphereMesh(2);
  FrameNormals field(mesh);
  EXPECT_TRUE(field.Compute(mesh.positions).empty());
  EXPECT_TRUE(field.normal_triangles().empty());
}

TEST(FrameNormals, TheReferenceKeepsExactlyItsOwn) {
  std::mt19937 random(1);
  Mesh mesh = SphereMesh(3);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.normals.push_back(ToVec3f(RandomVector(random)));
  FrameNormals field(mesh);
  EXPECT_EQ(field.Compute(mesh.positions), mesh.normals);
  EXPECT_TRUE(field.normal_triangles().empty());
}

TEST(FrameNormals, TurnWithTheFrame) {
  for (const double angle : {0.01, 1.0, 3.0}) {
    const Eigen::Matrix3d turn = AxisAngle({1, -2, 0.5}, angle);
    Mesh mesh = SphereMesh(3);
    mesh.normals = VertexNormals(mesh.positions, mesh.triangles);
    EXPECT_LT(Apart(FrameNormals(mesh).Compute(Moved(mesh.positions, turn, {5, 6, 7})), mesh.normals, turn), 1e-5);
    // The author's own, which lean away from the surface, do as well.
    std::mt19937 random(2);
    for (Vec3f& n : mesh.normals) n = ToVec3f(RandomVector(random));
    EXPECT_LT(Apart(FrameNormals(mesh).Compute(Moved(mesh.positions, turn, {5, 6, 7})), mesh.normals, turn), 1e-5);
  }
}

// About the axis of a cap each normal turns about itself, which the directions of triangles alone do not show.
TEST(FrameNormals, TurnAboutThemselves) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals.assign(3, {0.6f, 0, 0.8f});
  FrameNormals field(mesh);
  const Eigen::Matrix3d turn = AxisAngle({0, 0, 1}, 1.2);
  EXPECT_LT(Apart(field.Compute(Moved(mesh.positions, turn, {0, 0, 0})), mesh.normals, turn), 1e-6);
}

TEST(FrameNormals, HardEdgesStayHard) {
  const Mesh cube = HardCubeMesh();
  FrameNormals field(cube);
  const std::vector<Triangle> corners = field.normal_triangles();
  ASSERT_EQ(corners.size(), 12u);
  const auto normal_of = [&](const std::vector<Vec3f>& normals, std::size_t j, std::size_t k) {
    return ToVector(normals.at(corners[j][k]));
  };
  const std::vector<Vec3f> own = field.Compute(cube.positions);
  EXPECT_EQ(own.size(), 24u);  // one for each face at each vertex
  const Eigen::Matrix3d turn = AxisAngle({1, 1, 0}, 0.8);
  const std::vector<Vec3f> turned = field.Compute(Moved(cube.positions, turn, {0, 0, 3}));
  for (std::size_t j = 0; j < 12; ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(normal_of(own, j, k), ToVector(cube.normals[cube.normal_triangles[j][k]]));
      EXPECT_LT((normal_of(turned, j, k) - turn * normal_of(own, j, k)).norm(), 1e-6);
    }
  }
  // A face that folds along its diagonal: its corners, which shared one normal, do no longer.
  Positions folded = cube.positions;
  folded[7] = {2, 2, 1};
  const std::vector<Vec3f> normals = field.Compute(folded);
  EXPECT_LT((normal_of(normals, 0, 0) - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-6);
  EXPECT_GT((normal_of(normals, 2, 1) - normal_of(normals, 2, 0)).norm(), 0.1);
  EXPECT_EQ(corners[2][0], corners[3][0]);  // where the triangles of the face meet they go on sharing one
}

TEST(FrameNormals, StayWhereThereIsNoArea) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}, {7, 0, 0}, {8, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {4, 5, 5}};
  mesh.normals = {{0, 0, 1}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  FrameNormals field(mesh);
  EXPECT_EQ(field.Compute(Positions(6, {1, 2, 3})), mesh.normals);  // collapsed
  Positions moved = mesh.positions;
  moved[4] = {7, 1, 1};
  moved[5] = {9, 3, 0};
  EXPECT_EQ(field.Compute(moved), mesh.normals);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(field.Compute(Positions(6, {kNan, kNan, kNan})), mesh.normals);
}

TEST(FrameNormals, TurnOverWithASurface) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0, 0, 2}};
  FrameNormals field(mesh);
  const std::vector<Vec3f> over = {{0, 0, -1}, {0, 0.6f, -0.8f}, {0, 0, -2}};
  EXPECT_LT(Apart(field.Compute(Positions{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}), over, Eigen::Matrix3d::Identity()), 1e-6);
}

}  // namespace
}  // namespace sac

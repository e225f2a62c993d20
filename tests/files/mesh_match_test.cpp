// SPDX-License-Identifier: Apache-2.0
#include "files/mesh_match.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "synth/icosphere.h"

namespace sac {
namespace {

// A mesh with its vertices and triangles shuffled, triangles rotated, and positions off by up to `noise`.
struct Shuffled {
  Mesh mesh;
  VertexOrder order;  // of its vertices in the original
};

Shuffled Shuffle(const Mesh& mesh, double noise, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  Shuffled out;
  const std::size_t n = mesh.positions.size();
  out.order.resize(n);
  std::iota(out.order.begin(), out.order.end(), 0U);
  std::shuffle(out.order.begin(), out.order.end(), random);
  std::vector<std::uint32_t> place(n);
  for (std::uint32_t v = 0; v < n; ++v) {
    place[out.order[v]] = v;
    Vec3f p = mesh.positions[out.order[v]];
    for (float& x : p) x += static_cast<float>(noise * (random() * 0x1p-31 - 1) / std::numbers::sqrt3);
    out.mesh.positions.push_back(p);
  }
  for (Triangle t : mesh.triangles) {
    for (std::uint32_t& v : t) v = place[v];
    std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    out.mesh.triangles.push_back(t);
  }
  std::shuffle(out.mesh.triangles.begin(), out.mesh.triangles.end(), random);
  return out;
}

void ExpectMatch(const Mesh& mesh, double noise) {
  const Shuffled shuffled = Shuffle(mesh, noise);
  VertexOrder order;
  MatchDistance distance;
  const Status status = MatchVertices(shuffled.mesh, mesh, order, distance);
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(order, shuffled.order);
  EXPECT_LE(distance.largest, noise * 1.0001 + 1e-6);
}

std::string Error(const Mesh& decoded, const Mesh& author) {
  VertexOrder order;
  MatchDistance distance;
  return MatchVertices(decoded, author, order, distance).message();
}

// 10 frequency^2 + 2 vertices.
Mesh Sphere(std::uint32_t frequency) {
  const synth::Icosphere sphere = synth::MakeIcosphere(frequency);
  Mesh mesh;
  for (const Eigen::Vector3d& p : sphere.points) {
    mesh.positions.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  }
  mesh.triangles = sphere.triangles;
  return mesh;
}

// A grid of nu x nv vertices on a torus, which looks the same from each of them.
Mesh Torus(std::uint32_t nu, std::uint32_t nv) {
  Mesh mesh;
  for (std::uint32_t u = 0; u < nu; ++u) {
    for (std::uint32_t v = 0; v < nv; ++v) {
      const double a = 2 * std::numbers::pi * u / nu, b = 2 * std::numbers::pi * v / nv, r = 2 + std::cos(b);
      mesh.positions.push_back(
          {static_cast<float>(r * std::cos(a)), static_cast<float>(r * std::sin(a)), static_cast<float>(std::sin(b))});
      const std::uint32_t u1 = (u + 1) % nu, v1 = (v + 1) % nv;
      mesh.triangles.push_back({u * nv + v, u1 * nv + v, u1 * nv + v1});
      mesh.triangles.push_back({u * nv + v, u1 * nv + v1, u * nv + v1});
    }
  }
  return mesh;
}

void Append(const Mesh& part, const Vec3f& at, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3f& p : part.positions) mesh.positions.push_back({p[0] + at[0], p[1] + at[1], p[2] + at[2]});
  for (const auto& [a, b, c] : part.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
}

Mesh Tetrahedron() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

TEST(MeshMatchTest, PositionsChooseAmongSymmetries) {
  ExpectMatch(Tetrahedron(), 0.3);
  ExpectMatch(Sphere(16), 0.02);
  ExpectMatch(Torus(40, 24), 0.08);
}

TEST(MeshMatchTest, EqualParts) {
  Mesh mesh;
  for (int i = 0; i < 1000; ++i) {
    Append(Tetrahedron(),
           {static_cast<float>(3 * (i % 10)), static_cast<float>(3 * (i / 10 % 10)), static_cast<float>(3 * (i / 100))},
           mesh);
  }
  ExpectMatch(mesh, 0.3);
}

TEST(MeshMatchTest, PartsThatMeetAtAVertexOrAnEdge) {
  // Two tetrahedra at one vertex, three triangles at one edge, and one of them twice the other way round.
  Mesh mesh = Tetrahedron();
  mesh.positions.insert(mesh.positions.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {2, 0, 0}, {2, 1, 0}});
  mesh.triangles.insert(
      mesh.triangles.end(),
      {{0, 4, 5}, {0, 5, 6}, {0, 6, 4}, {4, 6, 5}, {1, 2, 7}, {2, 1, 8}, {1, 2, 8}, {1, 2, 8}, {3, 3, 1}, {8, 8, 8}});
  ExpectMatch(mesh, 0.05);
}

TEST(MeshMatchTest, VerticesWithoutTriangles) {
  Mesh mesh = Tetrahedron();
  for (int i = 0; i < 2000; ++i) {
    mesh.positions.push_back(
        {static_cast<float>(i % 20), static_cast<float>(i / 20 % 10), static_cast<float>(i / 200)});
  }
  ExpectMatch(mesh, 0.3);
  Mesh points;
  points.positions = mesh.positions;
  points.positions.erase(points.positions.begin(), points.positions.begin() + 4);
  ExpectMatch(points, 0.3);
  // All in one place: any order will do.
  points.positions.assign(3000, {1, 2, 3});
  VertexOrder order;
  MatchDistance distance;
  ASSERT_TRUE(MatchVertices(points, points, order, distance).ok());
  std::sort(order.begin(), order.end());
  for (std::uint32_t v = 0; v < order.size(); ++v) ASSERT_EQ(order[v], v);
}

// Where only one order suits the triangles, the author's mesh may be in another pose.
TEST(MeshMatchTest, AnIrregularMeshInAnotherPose) {
  Mesh mesh = Sphere(8);
  mesh.triangles.resize(mesh.triangles.size() - 5);
  mesh.triangles.erase(mesh.triangles.begin() + 17);
  Shuffled shuffled = Shuffle(mesh, 0);
  for (Vec3f& p : shuffled.mesh.positions) p = {p[1] * 3, -p[2], p[0] + 7};
  VertexOrder order;
  MatchDistance distance;
  ASSERT_TRUE(MatchVertices(shuffled.mesh, mesh, order, distance).ok());
  EXPECT_EQ(order, shuffled.order);
  EXPECT_GT(distance.mean, 3);
}

TEST(MeshMatchTest, OtherMeshes) {
  const Mesh sphere = Sphere(8);
  Mesh other = sphere;
  other.positions.push_back({});
  EXPECT_EQ(Error(sphere, other), "it has 643 vertices, the stream 642");
  other = sphere;
  other.triangles.pop_back();
  EXPECT_EQ(Error(sphere, other), "it has 1279 triangles, the stream 1280");
  const std::string differ = "its faces connect the vertices otherwise than those of the stream";
  other = sphere;
  std::swap(other.triangles[5][0], other.triangles[5][1]);
  EXPECT_EQ(Error(sphere, other), differ);
  // An edge turned within its two triangles.
  Mesh grid = Torus(8, 6), turned = grid;
  turned.triangles[0][2] = grid.triangles[1][2];
  turned.triangles[1][0] = grid.triangles[0][1];
  EXPECT_EQ(Error(grid, turned), differ);
  // A torus of as many vertices, every one of which looks the same.
  EXPECT_EQ(Error(Torus(8, 6), Torus(12, 4)), differ);
}

}  // namespace
}  // namespace sac

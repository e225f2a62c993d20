// SPDX-License-Identifier: Apache-2.0
// Normals of corners through the codec: hard edges come back, smooth meshes are as they were.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "sac/frame_normals.h"
#include "tests/hard_cube.h"
#include "tests/test_clips.h"

namespace sac {
namespace {

Clip Still(const Mesh& mesh) { return {mesh, {mesh.positions}}; }

// The vertices and the normal of a corner, by input vertices: of the corner itself, then of the next and the last.
using Corner = std::array<std::uint32_t, 3>;

std::multimap<Corner, Vec3f> NormalsByCorner(const Mesh& mesh, const std::vector<std::uint32_t>& order) {
  std::multimap<Corner, Vec3f> found;
  for (std::size_t j = 0; j < mesh.triangles.size(); ++j) {
    const Triangle& t = mesh.triangles[j];
    const Triangle& n = mesh.normal_triangles.empty() ? t : mesh.normal_triangles[j];
    for (std::size_t k = 0; k < 3; ++k) {
      found.emplace(Corner{order[t[k]], order[t[(k + 1) % 3]], order[t[(k + 2) % 3]]}, mesh.normals.at(n[k]));
    }
  }
  return found;
}

std::vector<std::uint32_t> InOrder(const Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.positions.size());
  for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
  return order;
}

// Each corner of the decoded mesh has the normal of its corner in the input, as exactly as 9 bits allow.
void ExpectNormals(const Mesh& input, const Decoded& decoded, const Encoded& encoded) {
  ASSERT_TRUE(decoded.status.ok()) << decoded.status.message();
  const auto wanted = NormalsByCorner(input, InOrder(input));
  const auto found = NormalsByCorner(decoded.mesh, encoded.order);
  ASSERT_EQ(found.size(), wanted.size());
  for (const auto& [corner, n] : found) {
    const auto at = wanted.find(corner);
    ASSERT_TRUE(at != wanted.end());
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(n[a], at->second[a], 0.01);
  }
}

// Corner normals of a smooth mesh: an index a corner, all with the values of the vertices.
Mesh Exploded(const Mesh& smooth) {
  Mesh mesh = smooth;
  mesh.normals.clear();
  for (const Triangle& t : smooth.triangles) {
    const auto i = static_cast<std::uint32_t>(mesh.normals.size());
    mesh.normal_triangles.push_back({i, i + 1, i + 2});
    for (const std::uint32_t v : t) mesh.normals.push_back(smooth.normals[v]);
  }
  return mesh;
}

TEST(CornerNormals, ACubeKeepsItsHardEdges) {
  const Mesh cube = HardCubeMesh();
  const Encoded encoded = Encode(Still(cube), {});
  const Decoded decoded = Decode(encoded.bytes);
  ExpectNormals(cube, decoded, encoded);
  EXPECT_EQ(decoded.mesh.positions.size(), 8u);
  EXPECT_EQ(decoded.mesh.normals.size(), 24u);
  EXPECT_EQ(decoded.mesh.normal_triangles.size(), 12u);
}

TEST(CornerNormals, OneHardEdgeOfASmoothMesh) {
  Mesh mesh = SphereMesh(4);
  mesh.normals = mesh.positions;
  mesh.normal_triangles = mesh.triangles;
  mesh.normals.push_back({0, 0, 1});
  mesh.normal_triangles[7] = Triangle{};
  mesh.normal_triangles[7].fill(static_cast<std::uint32_t>(mesh.normals.size() - 1));
  const Encoded encoded = Encode(Still(mesh), {});
  const Decoded decoded = Decode(encoded.bytes);
  ExpectNormals(mesh, decoded, encoded);
  EXPECT_EQ(decoded.mesh.normals.size(), mesh.positions.size() + 3);
}

TEST(CornerNormals, EqualOnesMakeNoSeam) {
  Mesh smooth = SphereMesh(4);
  smooth.normals = smooth.positions;
  const std::vector<std::uint8_t> plain = Encode(Still(smooth), {}).bytes;
  Mesh exploded = Exploded(smooth);
  EXPECT_EQ(Encode(Still(exploded), {}).bytes, plain);
  // Nor do those that differ by rounding, some of them where the quantizer decides: the sphere is symmetric.
  for (std::size_t i = 0; i < exploded.normals.size(); ++i) exploded.normals[i][i % 3] += 1e-6f * (i % 5);
  EXPECT_TRUE(Decode(Encode(Still(exploded), {}).bytes).mesh.normal_triangles.empty());
}

// Welds, loose triangles and loose vertices have normals by spec.md 5.3.
TEST(CornerNormals, OfOddMeshes) {
  std::mt19937 random(4);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    Mesh mesh;
    mesh.positions = RandomPositions(random, 3 + random() % 12);
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {0, -1, 0}};
    std::set<Triangle> different;
    for (int j = 0; j < 25; ++j) {
      Triangle t = RandomTriangle(random, mesh.positions.size());
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      if (different.insert(t).second) mesh.triangles.push_back(t);
    }
    for (std::size_t j = 0; j < mesh.triangles.size(); ++j) {
      Triangle& corners = mesh.normal_triangles.emplace_back();
      for (std::uint32_t& n : corners) n = static_cast<std::uint32_t>(random() % 4);
    }
    Clip clip = Still(mesh);
    const Encoded encoded = Encode(clip, {});
    const Decoded decoded = Decode(encoded.bytes);
    ASSERT_TRUE(decoded.status.ok()) << decoded.status.message();
    ASSERT_FALSE(decoded.mesh.normals.empty());
    const auto wanted = NormalsByCorner(mesh, InOrder(mesh));
    for (const auto& [corner, n] : NormalsByCorner(decoded.mesh, encoded.order)) {
      if (std::set(corner.begin(), corner.end()).size() < 3) continue;  // Draco takes no degenerate triangles
      const auto at = wanted.find(corner);
      ASSERT_TRUE(at != wanted.end());
      EXPECT_NEAR(n[0] * at->second[0] + n[1] * at->second[1] + n[2] * at->second[2], 1, 1e-3);
    }
  }
}

TEST(CornerNormals, AreLeftOutWhereDracoCannotCodeThem) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}};
  mesh.triangles = {{0, 1, 1}, {1, 0, 0}};
  mesh.normals = {{0, 0, 1}, {1, 0, 0}};
  mesh.normal_triangles = {{0, 0, 0}, {1, 1, 1}};
  EXPECT_TRUE(Decode(Encode(Still(mesh), {}).bytes).mesh.normals.empty());
  mesh.normal_triangles = {{0, 1, 1}, {1, 0, 0}};  // those of vertices
  const Decoded decoded = Decode(Encode(Still(mesh), {}).bytes);
  EXPECT_EQ(decoded.mesh.normals.size(), 2u);
  EXPECT_TRUE(decoded.mesh.normal_triangles.empty());
}

TEST(CornerNormals, TheInputIsChecked) {
  const auto message = [](const Mesh& mesh) {
    std::unique_ptr<Encoder> encoder;
    return Encoder::Create(mesh, {}, encoder).message();
  };
  Mesh mesh = HardCubeMesh();
  mesh.normal_triangles.pop_back();
  EXPECT_EQ(message(mesh), "normals for some triangles only");
  mesh = HardCubeMesh();
  mesh.normal_triangles[3][1] = 6;
  EXPECT_EQ(message(mesh), "a corner of a missing normal");
}

TEST(FrameNormalsOfAStream, FollowTheFrames) {
  Clip clip{HardCubeMesh(), {}};
  for (int t = 0; t < 5; ++t) {
    clip.frames.push_back(Moved(clip.mesh.positions, AxisAngle({1, 2, 3}, 0.4 * t), {0.1 * t, 0, 0}));
  }
  EncoderSettings settings;
  settings.quality = 90;
  const Decoded decoded = Decode(Encode(clip, settings).bytes);
  ASSERT_TRUE(decoded.status.ok());
  FrameNormals field(decoded.mesh);
  for (int t = 0; t < 5; ++t) {
    const Eigen::Matrix3d turn = AxisAngle({1, 2, 3}, 0.4 * t);
    const std::vector<Vec3f> normals = field.Compute(decoded.frames[static_cast<std::size_t>(t)].positions);
    for (std::size_t j = 0; j < decoded.mesh.triangles.size(); ++j) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f& n = normals[field.normal_triangles()[j][k]];
        const Vec3f& n0 = decoded.mesh.normals[decoded.mesh.normal_triangles[j][k]];
        const Eigen::Vector3d expected = turn * Eigen::Vector3d(n0[0], n0[1], n0[2]);
        EXPECT_LT((Eigen::Vector3d(n[0], n[1], n[2]) - expected).norm(), 0.03) << t;
      }
    }
  }
}

}  // namespace
}  // namespace sac

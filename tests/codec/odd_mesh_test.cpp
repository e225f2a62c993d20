// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/test_clips.h"

namespace sac {
namespace {

// Triangles by input vertices, smallest first in each, with their number.
std::map<Triangle, int> Count(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& order = {}) {
  std::map<Triangle, int> count;
  for (Triangle t : triangles) {
    if (!order.empty()) t = {order.at(t[0]), order.at(t[1]), order.at(t[2])};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    if (t[0] == t[2]) t = {t[0], t[0], t[1]};  // of a degenerate triangle's turns one
    ++count[t];
  }
  return count;
}

bool IsPermutation(std::vector<std::uint32_t> order) {
  std::sort(order.begin(), order.end());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    if (order[i] != i) return false;
  }
  return true;
}

// The step of the I-frame where edges are longest.
double LargestStep(const Mesh& mesh, double bits) {
  double extent = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax_element(mesh.positions.begin(), mesh.positions.end(),
                                                 [a](const Vec3f& p, const Vec3f& q) { return p[a] < q[a]; });
    extent = std::max(extent, static_cast<double>((*high)[a]) - (*low)[a]);
  }
  std::vector<double> lengths = {1};
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f &p = mesh.positions[t[k]], &q = mesh.positions[t[(k + 1) % 3]];
      lengths.push_back(std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    }
  }
  std::sort(lengths.begin(), lengths.end());
  return extent / std::exp2(bits) * std::max(1.0, lengths.back() / std::max(lengths[lengths.size() / 2], 1e-9));
}

// A clip of `mesh` that grows a little, coded and decoded: every vertex and triangle comes back.
Decoded ExpectComplete(const Mesh& mesh, Encoded& encoded) {
  Clip clip{mesh, {}};
  for (int t = 0; t < 4; ++t) {
    clip.frames.push_back(mesh.positions);
    for (Vec3f& p : clip.frames.back()) p = {p[0] * (1 + 0.1f * t), p[1], p[2] + 0.05f * t};
  }
  EncoderSettings settings;
  settings.keep_order = true;
  settings.harmonics = 1000000;  // all there are, in components of no area too
  settings.position_bits = 10;
  encoded = Encode(clip, settings);
  const Decoded decoded = Decode(encoded.bytes);
  EXPECT_TRUE(decoded.status.ok()) << decoded.status.message();
  EXPECT_EQ(decoded.mesh.positions.size(), mesh.positions.size());
  EXPECT_EQ(decoded.frames.size(), clip.frames.size());
  EXPECT_TRUE(IsPermutation(encoded.order));
  EXPECT_EQ(decoded.order, encoded.order);
  if (!decoded.status.ok() || encoded.order.size() != mesh.positions.size()) return decoded;
  EXPECT_EQ(Count(decoded.mesh.triangles, encoded.order), Count(mesh.triangles));

  const double rms = RmsRadius(mesh.positions), cell = LargestStep(mesh, *settings.position_bits);
  EXPECT_LE(MaxError(mesh.positions, decoded.mesh.positions, encoded.order), 2 * cell + 1e-6 * rms);
  for (std::size_t t = 0; t < decoded.frames.size(); ++t) {
    const double bound = t == 0 ? cell + 0.01 * rms : cell + 0.05 * rms;
    EXPECT_LE(RmsError(clip.frames[t], decoded.frames[t].positions, encoded.order), bound) << "frame " << t;
  }
  return decoded;
}

Mesh Make(const Positions& positions, const std::vector<Triangle>& triangles) {
  Mesh mesh;
  mesh.positions = positions;
  mesh.triangles = triangles;
  return mesh;
}

const Positions kSix = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {-1, 0.5f, 0.5f}};

Mesh MoebiusMesh() {
  Mesh moebius;
  for (std::uint32_t s = 0; s < 20; ++s) {
    const double angle = 2 * std::numbers::pi * s / 20;
    for (const double side : {-0.3, 0.3}) {
      const double radius = 1 + side * std::cos(angle / 2);
      moebius.positions.push_back(
          ToVec3f({radius * std::cos(angle), radius * std::sin(angle), side * std::sin(angle / 2)}));
    }
    const std::uint32_t a = 2 * s, b = 2 * s + 1;
    const std::uint32_t c = s + 1 < 20 ? a + 2 : 1, d = s + 1 < 20 ? b + 2 : 0;  // the last ones cross over
    moebius.triangles.push_back({a, c, b});
    moebius.triangles.push_back({b, c, d});
  }
  return moebius;
}

TEST(OddMesh, ComesBackComplete) {
  const Mesh sphere = SphereMesh(2);
  Mesh turned = sphere;
  for (std::size_t j = 0; j < turned.triangles.size(); j += 3)
    std::swap(turned.triangles[j][0], turned.triangles[j][1]);
  Mesh doubled = sphere;
  doubled.triangles.insert(doubled.triangles.end(), sphere.triangles.begin(), sphere.triangles.end());
  Mesh both_sides = sphere;
  for (const Triangle& t : sphere.triangles) both_sides.triangles.push_back({t[1], t[0], t[2]});
  Mesh touching = SphereMesh(2);  // two spheres with one vertex in common
  AppendMesh(touching, SphereMesh(2), {2, 0, 0});
  for (Triangle& t : touching.triangles) {
    for (std::uint32_t& v : t) v = v == 42 ? 0 : v > 42 ? v - 1 : v;
  }
  touching.positions.erase(touching.positions.begin() + 42);
  Mesh with_loose = sphere;
  with_loose.positions.insert(with_loose.positions.begin() + 5, {3, 3, 3});
  for (Triangle& t : with_loose.triangles) {
    for (std::uint32_t& v : t) v += v >= 5;
  }
  Mesh coincident = sphere;  // different vertices at one place
  coincident.positions[3] = coincident.positions[7] = coincident.positions[11];

  const std::map<const char*, Mesh> meshes = {
      {"one triangle", Make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}})},
      {"a triangle backwards", Make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{2, 1, 0}})},
      {"only vertices", Make(kSix, {})},
      {"only degenerate triangles", Make(kSix, {{0, 0, 0}, {1, 2, 1}, {1, 2, 2}, {5, 4, 4}, {4, 5, 4}})},
      {"a triangle and its duplicates", Make(kSix, {{0, 1, 2}, {1, 2, 0}, {0, 1, 2}, {3, 4, 5}})},
      {"a triangle and its back", Make(kSix, {{0, 1, 2}, {0, 2, 1}, {3, 4, 5}})},
      {"four triangles at an edge", Make(kSix, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {1, 0, 5}})},
      {"a bow tie", Make({kSix.begin(), kSix.begin() + 5}, {{0, 1, 2}, {0, 3, 4}})},
      {"a collinear triangle", Make({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 3}})},
      {"Moebius", MoebiusMesh()},
      {"turned triangles", turned},
      {"all triangles twice", doubled},
      {"both sides", both_sides},
      {"touching components", touching},
      {"a loose vertex within", with_loose},
      {"coincident vertices", coincident},
      {"parts", PartsMesh()},
      {"a tube", TubeMesh(7, 5)},
  };
  for (const auto& [name, mesh] : meshes) {
    SCOPED_TRACE(name);
    Encoded encoded;
    ExpectComplete(mesh, encoded);
  }
}

TEST(OddMesh, RandomTrianglesComeBack) {
  std::mt19937 random(1);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    Mesh mesh;
    mesh.positions = RandomPositions(random, 2 + random() % 20);
    mesh.triangles.resize(random() % 40);
    for (Triangle& t : mesh.triangles) t = RandomTriangle(random, mesh.positions.size());
    Encoded encoded;
    ExpectComplete(mesh, encoded);
  }
}

TEST(OddMesh, OrderIsSentOnlyWhenAsked) {
  const Clip clip = BendingClip(2);
  EXPECT_TRUE(Decode(Encode(clip, {}).bytes).order.empty());
}

TEST(Attributes, NormalsAndColoursComeBack) {
  Mesh mesh = PartsMesh();
  std::mt19937 random(2);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    mesh.normals.push_back(ToVec3f(RandomVector(random).normalized()));
    mesh.colors.push_back({static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
                           static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(v)});
  }
  Encoded encoded;
  const Decoded decoded = ExpectComplete(mesh, encoded);
  ASSERT_EQ(decoded.mesh.normals.size(), mesh.normals.size());
  ASSERT_EQ(decoded.mesh.colors.size(), mesh.colors.size());
  for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
    const Vec3f &a = mesh.normals[encoded.order[v]], &b = decoded.mesh.normals[v];
    EXPECT_NEAR(a[0] * b[0] + a[1] * b[1] + a[2] * b[2], 1, 1e-3);
    EXPECT_EQ(decoded.mesh.colors[v], mesh.colors[encoded.order[v]]);
  }
}

TEST(Attributes, TextureCoordinatesComeBackWithTheirSeams) {
  Mesh mesh = TubeMesh(6, 8);
  // A seam along the tube: its vertices have two coordinates, and all of them one more on the last ring's triangles.
  std::map<std::array<float, 2>, std::uint32_t> index;
  for (const Triangle& t : mesh.triangles) {
    Triangle& corners = mesh.uv_triangles.emplace_back();
    const bool wraps = std::max({t[0] % 8, t[1] % 8, t[2] % 8}) == 7 && std::min({t[0] % 8, t[1] % 8, t[2] % 8}) == 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t s = t[k] % 8 + (wraps && t[k] % 8 == 0 ? 8 : 0);
      const std::array<float, 2> uv = {static_cast<float>(s) / 8, static_cast<float>(t[k] / 8) / 6};
      const auto [at, is_new] = index.try_emplace(uv, static_cast<std::uint32_t>(mesh.uvs.size()));
      if (is_new) mesh.uvs.push_back(uv);
      corners[k] = at->second;
    }
  }
  ASSERT_GT(mesh.uvs.size(), mesh.positions.size());
  Encoded encoded;
  const Decoded decoded = ExpectComplete(mesh, encoded);
  ASSERT_EQ(decoded.mesh.uv_triangles.size(), decoded.mesh.triangles.size());
  // Triangles of different vertices: each is found by them.
  std::map<Triangle, std::size_t> input;
  for (std::size_t j = 0; j < mesh.triangles.size(); ++j) input[mesh.triangles[j]] = j;
  for (std::size_t j = 0; j < decoded.mesh.triangles.size(); ++j) {
    Triangle t = decoded.mesh.triangles[j], corners = decoded.mesh.uv_triangles[j];
    for (std::uint32_t& v : t) v = encoded.order[v];
    for (int turn = 0; turn < 3 && !input.contains(t); ++turn) {
      std::rotate(t.begin(), t.begin() + 1, t.end());
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    }
    ASSERT_TRUE(input.contains(t));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto &a = mesh.uvs[mesh.uv_triangles[input[t]][k]], &b = decoded.mesh.uvs.at(corners[k]);
      EXPECT_NEAR(a[0], b[0], 1e-3);
      EXPECT_NEAR(a[1], b[1], 1e-3);
    }
  }
}

}  // namespace
}  // namespace sac

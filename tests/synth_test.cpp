// SPDX-License-Identifier: Apache-2.0
#include "synth/synth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace sac {
namespace {

constexpr SynthKind kAllKinds[] = {SynthKind::kWalker, SynthKind::kFlag, SynthKind::kSphere, SynthKind::kParts,
                                   SynthKind::kVase};

const char* Name(SynthKind kind) { return kSynthKindNames[static_cast<std::size_t>(kind)]; }

SynthClip Make(SynthKind kind, std::uint32_t vertices, std::uint32_t seed = 1) {
  SynthClip clip;
  const Status status = SynthClip::Create({.kind = kind, .vertices = vertices, .frames = 60, .seed = seed}, clip);
  EXPECT_TRUE(status.ok()) << status.message();
  return clip;
}

double Distance(const Vec3f& p, const Vec3f& q) {
  return std::hypot(double{p[0]} - q[0], double{p[1]} - q[1], double{p[2]} - q[2]);
}

// For each vertex the smallest vertex of its component.
std::vector<std::uint32_t> Components(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 2; ++k) {
      const auto [low, high] = std::minmax({root(t[k]), root(t[k + 1])});
      parent[high] = low;
    }
  }
  for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = root(v);
  return parent;
}

std::size_t ComponentCount(const Mesh& mesh) {
  const std::vector<std::uint32_t> c = Components(mesh);
  return std::set<std::uint32_t>(c.begin(), c.end()).size();
}

// Every edge has two triangles, which go through it in opposite directions.
bool IsClosedAndOriented(const Mesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> directed;
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      if (!directed.insert({t[k], t[(k + 1) % 3]}).second) return false;
    }
  }
  return std::all_of(directed.begin(), directed.end(), [&](const auto& e) {
    return directed.contains({e.second, e.first});
  });
}

double Volume(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      sum += double{a[k]} * (double{b[l]} * c[m] - double{b[m]} * c[l]) / 6;
    }
  }
  return sum;
}

// The Euler characteristic of a closed surface of triangles: 3 triangles make 2 edges.
std::int64_t Euler(const Mesh& mesh) {
  const auto n = static_cast<std::int64_t>(mesh.positions.size()), m = static_cast<std::int64_t>(mesh.triangles.size());
  return n - m * 3 / 2 + m;
}

TEST(Synth, HasAboutTheVerticesAskedFor) {
  for (const SynthKind kind : kAllKinds) {
    for (const std::uint32_t vertices : {2500u, 5000u, 7777u}) {
      const Mesh mesh = Make(kind, vertices).mesh();
      EXPECT_NEAR(static_cast<double>(mesh.positions.size()), vertices, 0.15 * vertices) << Name(kind);
    }
  }
}

TEST(Synth, IsAValidMeshWithItsAttributes) {
  for (const SynthKind kind : kAllKinds) {
    const SynthClip clip = Make(kind, 3000);
    const Mesh& mesh = clip.mesh();
    const std::size_t n = mesh.positions.size();
    std::vector<bool> used(n);
    for (const Triangle& t : mesh.triangles) {
      EXPECT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
      for (const std::uint32_t v : t) {
        ASSERT_LT(v, n) << Name(kind);
        used[v] = true;
      }
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << Name(kind);

    const bool has_uvs = kind == SynthKind::kFlag || kind == SynthKind::kVase;
    EXPECT_EQ(mesh.uv_triangles.size(), has_uvs ? mesh.triangles.size() : 0) << Name(kind);
    for (const Triangle& t : mesh.uv_triangles) {
      for (const std::uint32_t i : t) ASSERT_LT(i, mesh.uvs.size());
    }
    for (const auto& uv : mesh.uvs) EXPECT_TRUE(uv[0] >= 0 && uv[0] <= 1 && uv[1] >= 0 && uv[1] <= 1);
    EXPECT_EQ(mesh.colors.size(), kind == SynthKind::kParts ? n : 0);
    EXPECT_EQ(mesh.normals.size(), kind == SynthKind::kSphere ? n : 0);
    for (const Vec3f& normal : mesh.normals) EXPECT_NEAR(Distance(normal, {0, 0, 0}), 1, 1e-6);
  }
}

TEST(Synth, RepeatsItselfAndVariesWithTheSeed) {
  for (const SynthKind kind : kAllKinds) {
    const SynthClip a = Make(kind, 3000), b = Make(kind, 3000), c = Make(kind, 3000, 2);
    EXPECT_EQ(a.mesh().positions, a.Frame(0)) << Name(kind);
    EXPECT_EQ(a.mesh().triangles, b.mesh().triangles) << Name(kind);
    EXPECT_EQ(a.mesh().colors, b.mesh().colors) << Name(kind);
    EXPECT_EQ(a.Frame(47), b.Frame(47)) << Name(kind);
    EXPECT_NE(a.Frame(47), c.Frame(47)) << Name(kind);
  }
}

TEST(Synth, MovesSmoothly) {
  // The farthest that a vertex goes in a frame, in metres, and how much that may change to the next frame.
  const std::map<SynthKind, std::pair<double, double>> most{{SynthKind::kWalker, {0.3, 0.1}},
                                                            {SynthKind::kFlag, {0.1, 0.05}},
                                                            {SynthKind::kSphere, {0.08, 0.012}},
                                                            {SynthKind::kParts, {0.08, 0.012}},
                                                            {SynthKind::kVase, {0.06, 0.004}}};
  for (const SynthKind kind : kAllKinds) {
    for (const std::uint32_t seed : {1u, 2u}) {
      const SynthClip clip = Make(kind, 2500, seed);
      double largest_step = 0, largest_bend = 0, way = 0;
      Positions before = clip.Frame(0), now = clip.Frame(1);
      for (std::uint32_t f = 2; f < 120; ++f) {
        Positions after = clip.Frame(f);
        for (std::size_t v = 0; v < now.size(); ++v) {
          const double step = Distance(now[v], after[v]);
          ASSERT_TRUE(std::isfinite(step));
          largest_step = std::max(largest_step, step);
          way += step / static_cast<double>(now.size());
          const Vec3f guess{2 * now[v][0] - before[v][0], 2 * now[v][1] - before[v][1], 2 * now[v][2] - before[v][2]};
          largest_bend = std::max(largest_bend, Distance(guess, after[v]));
        }
        before = std::exchange(now, std::move(after));
      }
      EXPECT_LT(largest_step, most.at(kind).first) << Name(kind);
      EXPECT_LT(largest_bend, most.at(kind).second) << Name(kind);
      EXPECT_GT(way, 1) << Name(kind);
    }
  }
}

TEST(SynthWalker, IsOneClosedSurface) {
  // Seeds whose thin parts come off on coarse lattices unless the body is made stouter.
  for (const auto& [vertices, seed] : {std::pair{2000u, 19u}, {2100u, 9u}, {2300u, 16u}, {6000u, 1u}}) {
    const SynthClip clip = Make(SynthKind::kWalker, vertices, seed);
    EXPECT_EQ(ComponentCount(clip.mesh()), 1u);
    EXPECT_TRUE(IsClosedAndOriented(clip.mesh()));
    EXPECT_GT(Volume(clip.mesh()), 0.05);
    if (vertices == 6000) {
      EXPECT_EQ(Euler(clip.mesh()), 2);
    }
  }
}

TEST(SynthWalker, DoesNotTear) {
  const SynthClip clip = Make(SynthKind::kWalker, 6000);
  for (std::uint32_t f = 0; f < 150; f += 3) {
    const Positions p = clip.Frame(f);
    for (const Triangle& t : clip.mesh().triangles) ASSERT_LT(Distance(p[t[0]], p[t[1]]), 0.15);
  }
}

TEST(SynthFlag, IsARectangleThatHardlyStretches) {
  const SynthClip clip = Make(SynthKind::kFlag, 5000);
  const Mesh& mesh = clip.mesh();
  EXPECT_EQ(ComponentCount(mesh), 1u);
  for (const std::uint32_t f : {0u, 30u, 59u}) {
    const Positions p = clip.Frame(f);
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
      const auto &a = mesh.uvs[i], &b = mesh.uvs[i + 1];
      if (a[0] == 0) {
        EXPECT_EQ(p[i], mesh.positions[i]);  // pinned
      }
      // Along a row, on a flag 1.5 m long.
      if (a[1] == b[1]) {
        ASSERT_NEAR(Distance(p[i], p[i + 1]), 1.5 * (b[0] - a[0]), 1e-4);
      }
    }
  }
}

TEST(SynthSphere, IsAGeodesicSphere) {
  for (const std::uint32_t frequency : {1u, 2u, 3u, 7u, 20u}) {
    const Mesh mesh = Make(SynthKind::kSphere, 10 * frequency * frequency + 2).mesh();
    EXPECT_EQ(mesh.positions.size(), 10 * frequency * frequency + 2);
    EXPECT_EQ(ComponentCount(mesh), 1u);
    EXPECT_TRUE(IsClosedAndOriented(mesh));
    EXPECT_EQ(Euler(mesh), 2);
    EXPECT_GT(Volume(mesh), 2.5);
    for (const Vec3f& p : mesh.positions) ASSERT_NEAR(Distance(p, {0, 0, 0}), 1, 1e-6);
  }
}

TEST(SynthParts, AreManyRigidPieces) {
  for (const auto& [vertices, pieces] : {std::pair{4u, 1u}, {40u, 10u}, {1000u, 100u}, {26000u, 1000u}}) {
    const SynthClip clip = Make(SynthKind::kParts, vertices);
    const Mesh& mesh = clip.mesh();
    EXPECT_EQ(ComponentCount(mesh), pieces);
    EXPECT_TRUE(IsClosedAndOriented(mesh));
    EXPECT_GT(Volume(mesh), 0);
    const std::vector<std::uint32_t> component = Components(mesh);
    const Positions p = clip.Frame(50);
    for (std::size_t v = 0; v < p.size(); ++v) {
      const std::uint32_t first = component[v];
      ASSERT_NEAR(Distance(p[v], p[first]), Distance(mesh.positions[v], mesh.positions[first]), 1e-5);
      EXPECT_EQ(mesh.colors[v], mesh.colors[first]);
    }
  }
}

TEST(SynthVase, IsOneClosedRigidSurface) {
  for (const std::uint32_t vertices : {50u, 4000u}) {
    const SynthClip clip = Make(SynthKind::kVase, vertices);
    const Mesh& mesh = clip.mesh();
    EXPECT_EQ(ComponentCount(mesh), 1u);
    EXPECT_TRUE(IsClosedAndOriented(mesh));
    EXPECT_EQ(Euler(mesh), 2);
    EXPECT_GT(Volume(mesh), 0);
    for (const std::uint32_t f : {1u, 30u, 59u}) {
      const Positions p = clip.Frame(f);
      for (std::size_t v = 0; v < p.size(); ++v) {
        const std::size_t w = v * 7919 % p.size();
        ASSERT_NEAR(Distance(p[v], p[w]), Distance(mesh.positions[v], mesh.positions[w]), 1e-6);
      }
    }
  }
}

TEST(Synth, RejectsWhatItCannotMake) {
  SynthClip clip = Make(SynthKind::kVase, 100);
  const std::size_t vertices = clip.mesh().positions.size();
  for (const SynthKind kind : kAllKinds) {
    const std::uint32_t least = MinSynthVertices(kind);
    for (const SynthSettings& bad :
         {SynthSettings{kind, 0, 1, 1}, SynthSettings{kind, least - 1, 1, 1},
          SynthSettings{kind, kMaxSynthVertices + 1, 1, 1}, SynthSettings{kind, least, 0, 1}}) {
      EXPECT_EQ(SynthClip::Create(bad, clip).code(), StatusCode::kInvalidArgument) << Name(kind);
      EXPECT_EQ(clip.mesh().positions.size(), vertices);
    }
    EXPECT_GT(Make(kind, least).mesh().triangles.size(), 0u);
  }
  EXPECT_EQ(SynthClip::Create({.kind = static_cast<SynthKind>(9)}, clip).code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace sac

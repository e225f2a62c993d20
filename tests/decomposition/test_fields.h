// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "sac/clip.h"
#include "sac/sparse_components.h"
#include "tests/test_meshes.h"

namespace sac {

// A square of side 1 in the plane z = 0: n x n vertices.
inline Mesh GridMesh(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      mesh.positions.push_back(ToVec3f({x / (n - 1.0), y / (n - 1.0), 0}));
    }
  }
  for (std::uint32_t y = 0; y + 1 < n; ++y) {
    for (std::uint32_t x = 0; x + 1 < n; ++x) {
      const std::uint32_t a = y * n + x;
      mesh.triangles.push_back({a, a + 1, a + n + 1});
      mesh.triangles.push_back({a, a + n + 1, a + n});
    }
  }
  return mesh;
}

// Bumps on a grid: known local components with independent weights.
struct Bumps {
  Clip clip;
  std::vector<std::vector<double>> height;   // a bump: one a vertex
  std::vector<std::vector<double>> weights;  // a bump: one a frame, from -1 to 1; 0 in the first frame
};

// `per_side`^2 bumps with disjoint supports on a grid of n x n vertices.
inline Bumps BumpClip(std::uint32_t n, std::uint32_t per_side, std::uint32_t frames, std::uint32_t seed = 7) {
  Bumps bumps;
  bumps.clip.mesh = GridMesh(n);
  const double spacing = 1.0 / per_side, radius = 0.4 * spacing;
  std::mt19937 random(seed);
  for (std::uint32_t b = 0; b < per_side * per_side; ++b) {
    const double cx = (b % per_side + 0.5) * spacing, cy = (b / per_side + 0.5) * spacing;
    std::vector<double>& height = bumps.height.emplace_back();
    for (const Vec3f& p : bumps.clip.mesh.positions) {
      const double d = std::hypot(static_cast<double>(p[0]) - cx, static_cast<double>(p[1]) - cy) / radius;
      height.push_back(d < 1 ? 0.05 * (1 - d * d) * (1 - d * d) : 0);
    }
    std::vector<double>& weights = bumps.weights.emplace_back();
    for (std::uint32_t f = 0; f < frames; ++f) weights.push_back(f == 0 ? 0 : Signed(random));
  }
  for (std::uint32_t f = 0; f < frames; ++f) {
    Positions positions = bumps.clip.mesh.positions;
    for (std::size_t v = 0; v < positions.size(); ++v) {
      double z = 0;
      for (std::size_t b = 0; b < bumps.height.size(); ++b) z += bumps.weights[b][f] * bumps.height[b][v];
      positions[v][2] += static_cast<float>(z);
    }
    bumps.clip.frames.push_back(positions);
  }
  return bumps;
}

// The components of `clip`; fails the test where there is an error.
inline SparseComponents Decomposed(const Clip& clip, const DecompositionSettings& settings,
                                   DecompositionReport* report = nullptr) {
  MemoryClipReader reader(clip);
  SparseComponents result;
  DecompositionReport ignored;
  const Status status = DecomposeClip(reader, settings, result, report != nullptr ? *report : ignored);
  EXPECT_TRUE(status.ok()) << status.message();
  return result;
}

inline double Erms(const Clip& clip, const SparseComponents& components) {
  MemoryClipReader reader(clip);
  ReconstructionError error;
  const Status status = MeasureComponents(reader, components, error);
  EXPECT_TRUE(status.ok()) << status.message();
  return error.erms;
}

inline double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += a[i] * b[i];
    aa += a[i] * a[i];
    bb += b[i] * b[i];
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

// The z values of component k, one a vertex.
inline std::vector<double> HeightOf(const SparseComponents& c, std::size_t k) {
  std::vector<double> height(c.rest.size(), 0);
  const SparseComponent& component = c.components[k];
  for (std::size_t i = 0; i < component.nodes.size(); ++i) {
    height[component.nodes[i]] = static_cast<double>(component.values[3 * i + 2]);
  }
  return height;
}

}  // namespace sac

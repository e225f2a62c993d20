// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "sac/sparse_components.h"
#include "tests/decomposition/test_fields.h"

namespace sac {
namespace {

DecompositionSettings BumpSettings(std::uint32_t count) {
  DecompositionSettings settings;
  settings.count = count;
  settings.near = 0.05;
  settings.far = 0.25;
  return settings;
}

double WeightCorrelation(const SparseComponents& a, std::size_t k, const SparseComponents& b, std::size_t l) {
  std::vector<double> x, y;
  for (std::size_t f = 0; f < a.frames(); ++f) {
    x.push_back(static_cast<double>(a.weight(f, k)));
    y.push_back(static_cast<double>(b.weight(f, l)));
  }
  return Correlation(x, y);
}

// The least over the components of `a` of the largest |correlation| of its weights with those of one of `b`.
double WorstMatch(const SparseComponents& a, const SparseComponents& b) {
  double worst = 1;
  for (std::size_t k = 0; k < a.components.size(); ++k) {
    double best = 0;
    for (std::size_t l = 0; l < b.components.size(); ++l) {
      best = std::max(best, std::abs(WeightCorrelation(a, k, b, l)));
    }
    worst = std::min(worst, best);
  }
  return worst;
}

TEST(DecomposeClip, FindsKnownComponents) {
  const Bumps bumps = BumpClip(31, 3, 40);
  const SparseComponents found = Decomposed(bumps.clip, BumpSettings(9));
  ASSERT_EQ(found.components.size(), 9u);
  std::set<std::size_t> taken;
  for (std::size_t b = 0; b < bumps.height.size(); ++b) {
    std::size_t best = 0;
    double largest = 0;
    for (std::size_t k = 0; k < 9; ++k) {
      const double c = std::abs(Correlation(bumps.height[b], HeightOf(found, k)));
      if (c > largest) {
        largest = c;
        best = k;
      }
    }
    EXPECT_GT(largest, 0.95) << b;
    EXPECT_TRUE(taken.insert(best).second) << b;
    std::vector<double> weights;
    for (std::size_t f = 0; f < found.frames(); ++f) weights.push_back(static_cast<double>(found.weight(f, best)));
    EXPECT_GT(std::abs(Correlation(weights, bumps.weights[b])), 0.95) << b;
    // The supports agree where the bump is more than three tenths of its height; sparsity takes from its rim.
    std::size_t both = 0, either = 0;
    const std::vector<double> height = HeightOf(found, best);
    const double peak = std::abs(
        *std::max_element(height.begin(), height.end(), [](double x, double y) { return std::abs(x) < std::abs(y); }));
    for (std::size_t v = 0; v < height.size(); ++v) {
      const bool is = std::abs(height[v]) > 0.3 * peak, was = bumps.height[b][v] > 0.3 * 0.05;
      both += is && was ? 1 : 0;
      either += is || was ? 1 : 0;
    }
    EXPECT_GT(static_cast<double>(both), 0.9 * static_cast<double>(either)) << b;
  }
}

TEST(DecomposeClip, ObjectiveNeverRises) {
  for (const bool positive : {false, true}) {
    for (const ComponentDomain domain : {ComponentDomain::kDisplacement, ComponentDomain::kGradient}) {
      const Bumps bumps = BumpClip(21, 2, 20);
      DecompositionSettings settings = BumpSettings(6);
      settings.positive = positive;
      settings.domain = domain;
      settings.iterations = 60;
      settings.tolerance = 0;
      DecompositionReport report;
      Decomposed(bumps.clip, settings, &report);
      ASSERT_GT(report.objective.size(), 1u);
      for (std::size_t i = 1; i < report.objective.size(); ++i) {
        EXPECT_LE(report.objective[i], report.objective[i - 1] * (1 + 5e-6)) << i;  // sums of floats
      }
    }
  }
}

TEST(DecomposeClip, WeightsKeepTheirBounds) {
  const Bumps bumps = BumpClip(21, 2, 20);
  for (const bool positive : {false, true}) {
    DecompositionSettings settings = BumpSettings(6);
    settings.positive = positive;
    const SparseComponents found = Decomposed(bumps.clip, settings);
    for (const float w : found.weights) {
      EXPECT_LE(w, 1);
      EXPECT_GE(w, positive ? 0 : -1);
    }
    for (std::size_t k = 0; k < found.components.size(); ++k) {
      float largest = 0;
      for (std::size_t f = 0; f < found.frames(); ++f) largest = std::max(largest, std::abs(found.weight(f, k)));
      EXPECT_TRUE(largest == 1 || found.components[k].nodes.empty()) << k;
    }
  }
}

TEST(DecomposeClip, IsTheSameForAnyNumberOfThreads) {
  const Bumps bumps = BumpClip(31, 3, 20);
  for (const ComponentDomain domain : {ComponentDomain::kDisplacement, ComponentDomain::kGradient}) {
    DecompositionSettings settings = BumpSettings(6);
    settings.domain = domain;
    settings.iterations = 25;
    settings.threads = 1;
    const SparseComponents one = Decomposed(bumps.clip, settings);
    for (const std::uint32_t threads : {2u, 8u}) {
      settings.threads = threads;
      const SparseComponents many = Decomposed(bumps.clip, settings);
      EXPECT_EQ(one.weights, many.weights);
      for (std::size_t k = 0; k < one.components.size(); ++k) {
        EXPECT_EQ(one.components[k].nodes, many.components[k].nodes);
        EXPECT_EQ(one.components[k].values, many.components[k].values);
      }
    }
  }
}

TEST(DecomposeClip, DoesNotDependOnRepetitionScaleAndPose) {
  const Bumps bumps = BumpClip(31, 2, 24);
  const SparseComponents plain = Decomposed(bumps.clip, BumpSettings(4));
  Clip twice = bumps.clip;
  twice.frames.insert(twice.frames.end(), bumps.clip.frames.begin(), bumps.clip.frames.end());
  SparseComponents repeated = Decomposed(twice, BumpSettings(4));
  repeated.track.resize(24);
  EXPECT_GT(WorstMatch(plain, repeated), 0.999);

  Clip scaled = bumps.clip;
  for (Positions& frame : scaled.frames) {
    for (Vec3f& p : frame) p = {40 * p[0], 40 * p[1], 40 * p[2]};
  }
  scaled.mesh.positions = scaled.frames[0];
  EXPECT_GT(WorstMatch(plain, Decomposed(scaled, BumpSettings(4))), 0.999);

  Clip moved = bumps.clip;
  for (std::size_t f = 0; f < moved.frames.size(); ++f) {
    const double t = static_cast<double>(f);
    moved.frames[f] = Moved(moved.frames[f], AxisAngle({1, 2, 3}, 0.7 * t), {t, 1 - t, 0.3 * t});
  }
  moved.mesh.positions = moved.frames[0];
  const SparseComponents free = Decomposed(moved, BumpSettings(4));
  EXPECT_GT(WorstMatch(plain, free), 0.999);
  EXPECT_LT(Erms(moved, free), 1.5 * Erms(bumps.clip, plain));
}

TEST(DecomposeClip, ALittleNoiseChangesLittle) {
  const Bumps bumps = BumpClip(31, 2, 24);
  const SparseComponents plain = Decomposed(bumps.clip, BumpSettings(4));
  Clip noisy = bumps.clip;
  std::mt19937 random(3);
  for (Positions& frame : noisy.frames) {
    for (Vec3f& p : frame) {
      for (float& x : p) x += static_cast<float>(1e-3 * 0.05 * Signed(random));  // of the height of a bump
    }
  }
  noisy.mesh.positions = noisy.frames[0];
  EXPECT_GT(WorstMatch(plain, Decomposed(noisy, BumpSettings(4))), 0.9999);
}

TEST(DecomposeClip, StrokesStayWhereTheyAre) {
  const Bumps bumps = BumpClip(31, 3, 30);
  DecompositionSettings settings = BumpSettings(9);
  const std::uint32_t centre = 15 * 31 + 15;  // of the bump in the middle
  settings.strokes.push_back({"middle", {centre}, {}});
  settings.strokes.push_back({"", {5 * 31 + 5, 5 * 31 + 6}, {}});
  const SparseComponents found = Decomposed(bumps.clip, settings);
  EXPECT_EQ(found.components[0].name, "middle");
  EXPECT_EQ(found.components[1].name, "stroke 1");
  EXPECT_EQ(found.components[0].centre, centre);
  const std::vector<double> height = HeightOf(found, 0);
  const auto peak = static_cast<std::uint32_t>(
      std::max_element(height.begin(), height.end(), [](double x, double y) { return std::abs(x) < std::abs(y); }) -
      height.begin());
  EXPECT_LE(std::abs(static_cast<int>(peak % 31) - 15), 2);
  EXPECT_LE(std::abs(static_cast<int>(peak / 31) - 15), 2);
}

TEST(DecomposeClip, AGivenComponentIsKept) {
  const Bumps bumps = BumpClip(31, 2, 24);
  DecompositionSettings settings = BumpSettings(5);
  const std::uint32_t at = 7 * 31 + 7;
  settings.strokes.push_back({"up", {at}, {{0, 0, 0.04f}}});
  const SparseComponents found = Decomposed(bumps.clip, settings);
  const SparseComponent& up = found.components[0];
  const auto node = std::find(up.nodes.begin(), up.nodes.end(), at);
  ASSERT_NE(node, up.nodes.end());
  EXPECT_NEAR(up.values[static_cast<std::size_t>(3 * (node - up.nodes.begin()) + 2)], 0.04, 1e-6);
  EXPECT_EQ(up.values[static_cast<std::size_t>(3 * (node - up.nodes.begin()))], 0);
  double moves = 0;
  for (std::size_t f = 0; f < found.frames(); ++f) moves = std::max(moves, std::abs(double{found.weight(f, 0)}));
  EXPECT_GT(moves, 0.1);
}

TEST(DecomposeClip, StillVerticesStayStill) {
  const Bumps bumps = BumpClip(21, 2, 20);
  for (const ComponentDomain domain : {ComponentDomain::kDisplacement, ComponentDomain::kGradient}) {
    DecompositionSettings settings = BumpSettings(4);
    settings.domain = domain;
    settings.still = {5 * 21 + 5, 5 * 21 + 6};
    const SparseComponents found = Decomposed(bumps.clip, settings);
    for (const SparseComponent& c : found.components) {
      for (const std::uint32_t node : c.nodes) {
        for (const std::uint32_t v : settings.still) {
          if (domain == ComponentDomain::kDisplacement) {
            EXPECT_NE(node, v);
          } else {
            const Triangle& t = found.triangles[node];
            EXPECT_TRUE(t[0] != v && t[1] != v && t[2] != v);
          }
        }
      }
    }
  }
}

TEST(DecomposeClip, ARotatingArmIsOneGradientComponentAndSeveralDisplacementOnes) {
  Clip clip{TubeMesh(40, 8), {}};
  for (int f = 0; f < 25; ++f) clip.frames.push_back(BentTube(clip.mesh, 0.1 * f));
  DecompositionSettings settings;
  settings.count = 1;
  settings.sparsity = 0.001;
  settings.domain = ComponentDomain::kGradient;
  const double one_gradient = Erms(clip, Decomposed(clip, settings));
  settings.domain = ComponentDomain::kDisplacement;
  const double one = Erms(clip, Decomposed(clip, settings));
  settings.count = 2;
  const double two = Erms(clip, Decomposed(clip, settings));
  EXPECT_LT(one_gradient, 6);
  EXPECT_GT(one, 4 * one_gradient);
  EXPECT_GT(two, one_gradient);
}

TEST(DecomposeClip, ReducedFramesLoseWhatIsSaid) {
  const Bumps bumps = BumpClip(31, 2, 60);
  DecompositionReport whole_report, report;
  DecompositionSettings settings = BumpSettings(4);
  const SparseComponents whole = Decomposed(bumps.clip, settings, &whole_report);
  EXPECT_EQ(whole_report.columns, 60u);
  EXPECT_EQ(whole_report.dropped_energy, 0);
  settings.field_memory = 8 * sizeof(float) * 3 * bumps.clip.mesh.positions.size();
  const SparseComponents reduced = Decomposed(bumps.clip, settings, &report);
  EXPECT_EQ(report.columns, 8u);
  EXPECT_LT(report.dropped_energy, 1e-3);
  EXPECT_GT(WorstMatch(whole, reduced), 0.999);
  settings.field_memory = 2 * sizeof(float) * 3 * bumps.clip.mesh.positions.size();
  Decomposed(bumps.clip, settings, &report);  // four bumps are not in two dimensions
  EXPECT_GT(report.dropped_energy, 0.2);
}

TEST(DecomposeClip, OddClips) {
  for (const ComponentDomain domain : {ComponentDomain::kDisplacement, ComponentDomain::kGradient}) {
    DecompositionSettings settings;
    settings.domain = domain;
    settings.count = 3;
    Clip still{PartsMesh(), {}};
    for (int f = 0; f < 3; ++f) still.frames.push_back(still.mesh.positions);
    const SparseComponents none = Decomposed(still, settings);
    for (const SparseComponent& c : none.components) {
      for (const float x : c.values) EXPECT_LT(std::abs(x), 1e-5);
    }
    Clip one{PartsMesh(), {}};
    one.frames = {one.mesh.positions};
    EXPECT_NEAR(Erms(one, Decomposed(one, settings)), 0, 1e-4);
  }
  Clip points;
  points.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int f = 0; f < 4; ++f) {
    points.frames.push_back(points.mesh.positions);
    points.frames.back()[1][1] += 0.1f * static_cast<float>(f);
  }
  DecompositionSettings settings;
  settings.count = 2;
  EXPECT_LT(Erms(points, Decomposed(points, settings)), 30);
}

TEST(DecomposeClip, RestShapes) {
  const Bumps bumps = BumpClip(21, 2, 20);
  DecompositionSettings settings = BumpSettings(4);
  settings.rest_shape = RestShape::kMean;
  const SparseComponents mean = Decomposed(bumps.clip, settings);
  double lift = 0, expected = 0;
  for (const double w : bumps.weights[0]) expected += w * 0.05 / 20;
  lift = static_cast<double>(mean.rest[5 * 21 + 5][2] - mean.rest[10 * 21 + 10][2]);
  EXPECT_NEAR(lift, expected, 0.002);
  settings.rest_shape = RestShape::kGiven;
  settings.rest = bumps.clip.frames[3];
  const SparseComponents given = Decomposed(bumps.clip, settings);
  EXPECT_EQ(given.rest, bumps.clip.frames[3]);
  EXPECT_LT(Erms(bumps.clip, given), 5);
}

TEST(DecomposeClip, Refuses) {
  const Bumps bumps = BumpClip(11, 2, 5);
  const auto expect = [](const Clip& clip, const DecompositionSettings& settings, StatusCode code,
                         const std::string& message) {
    MemoryClipReader reader(clip);
    SparseComponents result;
    DecompositionReport report;
    const Status status = DecomposeClip(reader, settings, result, report);
    EXPECT_EQ(status.code(), code) << message;
    EXPECT_EQ(status.message(), message);
  };
  DecompositionSettings settings;
  settings.count = 0;
  expect(bumps.clip, settings, StatusCode::kInvalidArgument, "the number of components is not from 1 to 4096");
  settings = {};
  settings.near = 0.6;
  expect(bumps.clip, settings, StatusCode::kInvalidArgument, "the support's radii are not 0 <= near < far");
  settings = {};
  settings.strokes = {{"eye", {121}, {}}};
  expect(bumps.clip, settings, StatusCode::kInvalidArgument, "stroke eye: there is no vertex 121 among 121");
  settings.strokes = {{"eye", {3}, {{1, 0, 0}, {1, 0, 0}}}};
  expect(bumps.clip, settings, StatusCode::kInvalidArgument, "stroke eye: 2 displacements for 1 vertices");
  settings.domain = ComponentDomain::kGradient;
  expect(bumps.clip, settings, StatusCode::kInvalidArgument,
         "stroke eye: displacements are for the displacement domain");
  settings = {};
  settings.rest_shape = RestShape::kGiven;
  expect(bumps.clip, settings, StatusCode::kInvalidArgument, "the rest shape has 0 vertices, not 121");
  settings = {};
  Clip none = bumps.clip;
  none.frames.clear();
  expect(none, settings, StatusCode::kInvalidArgument, "has no frames");
  Clip bad = bumps.clip;
  bad.frames[2][4][1] = NAN;
  expect(bad, settings, StatusCode::kInvalidArgument, "frame 2: a coordinate is not finite");
  bad.frames[2].pop_back();
  expect(bad, settings, StatusCode::kInvalidArgument, "frame 2: 120 vertices, not 121");
  Clip flat{{}, {}};
  flat.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  flat.mesh.triangles = {{0, 1, 2}};
  flat.frames = {flat.mesh.positions};
  settings.domain = ComponentDomain::kGradient;
  expect(flat, settings, StatusCode::kInvalidArgument, "no triangle of the rest shape has an area");
  settings = {};
  settings.progress = [](const DecompositionProgress& p) { return p.iteration < 3; };
  expect(bumps.clip, settings, StatusCode::kCancelled, "cancelled");
}

}  // namespace
}  // namespace sac

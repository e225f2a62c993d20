// SPDX-License-Identifier: Apache-2.0
#include "sac/component_poser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>

#include "tests/decomposition/test_fields.h"

namespace sac {
namespace {

std::unique_ptr<ComponentPoser> MakePoser(const SparseComponents& components) {
  std::unique_ptr<ComponentPoser> poser;
  const Status status = ComponentPoser::Create(components, poser);
  EXPECT_TRUE(status.ok()) << status.message();
  return poser;
}

DecompositionSettings Settings(std::uint32_t count, ComponentDomain domain = ComponentDomain::kDisplacement) {
  DecompositionSettings settings;
  settings.count = count;
  settings.domain = domain;
  settings.near = 0.05;
  settings.far = 0.25;
  return settings;
}

Clip BendingTube() {
  Clip clip{TubeMesh(30, 8), {}};
  for (int f = 0; f < 15; ++f) clip.frames.push_back(BentTube(clip.mesh, 0.1 * f));
  return clip;
}

double Distance(const Positions& a, const Positions& b) {
  double most = 0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) square += std::pow(static_cast<double>(a[v][i] - b[v][i]), 2);
    most = std::max(most, std::sqrt(square));
  }
  return most;
}

TEST(ComponentPoser, WhatNoComponentHasStaysExactlyWhereItIs) {
  const Bumps bumps = BumpClip(31, 2, 24);
  const SparseComponents components = Decomposed(bumps.clip, Settings(4));
  const auto poser = MakePoser(components);
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<float> weights(4, 0);
    weights[k] = 0.7f;
    Positions posed;
    ASSERT_TRUE(poser->Compose(weights, {}, posed).ok());
    std::vector<char> moves(posed.size(), 0);
    for (const std::uint32_t v : components.components[k].nodes) moves[v] = 1;
    std::size_t still = 0;
    for (std::size_t v = 0; v < posed.size(); ++v) {
      if (moves[v] != 0) continue;
      EXPECT_EQ(posed[v], components.rest[v]);
      ++still;
    }
    EXPECT_GT(still, posed.size() / 4);
  }
}

TEST(ComponentPoser, FitFindsTheWeightsOfAShape) {
  for (const ComponentDomain domain : {ComponentDomain::kDisplacement, ComponentDomain::kGradient}) {
    const Bumps bumps = BumpClip(21, 2, 24);
    const auto poser = MakePoser(Decomposed(bumps.clip, Settings(4, domain)));
    const std::vector<float> weights{0.5f, -0.8f, 0.1f, 0.9f};
    RigidPose pose;
    const Eigen::Matrix3d r = AxisAngle({1, 2, -1}, 2.5);
    for (int i = 0; i < 9; ++i) pose.rotation[static_cast<std::size_t>(i)] = r(i / 3, i % 3);
    pose.translation = {3, -2, 7};
    Positions shape;
    ASSERT_TRUE(poser->Compose(weights, pose, shape).ok());
    std::vector<float> found;
    RigidPose found_pose;
    ASSERT_TRUE(poser->Fit(shape, found, found_pose).ok());
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found[k], weights[k], 5e-3) << k;
    Positions again;
    ASSERT_TRUE(poser->Compose(found, found_pose, again).ok());
    EXPECT_LT(Distance(shape, again), 5e-4);
  }
}

TEST(ComponentPoser, FitKeepsTheBounds) {
  const Bumps bumps = BumpClip(21, 2, 24);
  DecompositionSettings settings = Settings(4);
  settings.positive = true;
  const auto poser = MakePoser(Decomposed(bumps.clip, settings));
  Positions shape;
  ASSERT_TRUE(poser->Compose(std::vector<float>{3, -2, 0.5f, 1}, {}, shape).ok());
  std::vector<float> found;
  RigidPose pose;
  ASSERT_TRUE(poser->Fit(shape, found, pose).ok());
  for (const float w : found) {
    EXPECT_GE(w, 0);
    EXPECT_LE(w, 1);
  }
}

TEST(ComponentPoser, APositionFitLowersTheErrorOfGradients) {
  const Clip clip = BendingTube();
  DecompositionSettings settings = Settings(3, ComponentDomain::kGradient);
  settings.fit_positions = false;
  const double before = Erms(clip, Decomposed(clip, settings));
  settings.fit_positions = true;
  EXPECT_LT(Erms(clip, Decomposed(clip, settings)), before);
}

TEST(ComponentPoser, DragMovesWhatIsNearAndLittleElse) {
  const Bumps bumps = BumpClip(31, 3, 30);
  const SparseComponents components = Decomposed(bumps.clip, Settings(9));
  const auto poser = MakePoser(components);
  const std::uint32_t centre = 15 * 31 + 15;
  Vec3f target = components.rest[centre];
  target[2] += 0.03f;
  const DragTarget drag{centre, target};
  std::vector<float> weights;
  DragSettings settings;
  ASSERT_TRUE(poser->Drag({&drag, 1}, settings, weights).ok());
  Positions posed;
  ASSERT_TRUE(poser->Compose(weights, {}, posed).ok());
  EXPECT_GT(posed[centre][2], components.rest[centre][2] + 0.95f * 0.03f);
  EXPECT_LT(std::abs(posed[0][2] - components.rest[0][2]), 1e-4f);
  EXPECT_LT(std::abs(posed[5 * 31 + 5][2] - components.rest[5 * 31 + 5][2]), 3e-3f);
  settings.bounded = true;
  const DragTarget far{centre, {0, 0, 100}};
  ASSERT_TRUE(poser->Drag({&far, 1}, settings, weights).ok());
  for (const float w : weights) EXPECT_LE(std::abs(w), 1);
}

TEST(ComponentPoser, DragOfGradients) {
  const Clip clip = BendingTube();
  const SparseComponents components = Decomposed(clip, Settings(3, ComponentDomain::kGradient));
  const auto poser = MakePoser(components);
  Positions bent;
  ASSERT_TRUE(poser->Compose(std::vector<float>{0.5f, 0.2f, -0.1f}, {}, bent).ok());
  const std::uint32_t tip = 29 * 8;
  const DragTarget drag{tip, bent[tip]};
  DragSettings settings;
  settings.price = 1e-4;
  std::vector<float> weights;
  ASSERT_TRUE(poser->Drag({&drag, 1}, settings, weights).ok());
  Positions posed;
  ASSERT_TRUE(poser->Compose(weights, {}, posed).ok());
  const double wanted = Distance({bent[tip]}, {components.rest[tip]});
  EXPECT_LT(Distance({posed[tip]}, {bent[tip]}), 0.05 * wanted);
}

TEST(ComponentPoser, StillVerticesOfGradientsDoNotMove) {
  const Clip clip = BendingTube();
  DecompositionSettings settings = Settings(3, ComponentDomain::kGradient);
  for (std::uint32_t v = 0; v < 8; ++v) settings.still.push_back(v);
  const SparseComponents components = Decomposed(clip, settings);
  const auto poser = MakePoser(components);
  Positions posed;
  ASSERT_TRUE(poser->Compose(std::vector<float>{1, 0.5f, 0}, {}, posed).ok());
  for (std::uint32_t v = 0; v < 8; ++v) EXPECT_EQ(posed[v], components.rest[v]);
  EXPECT_GT(Distance(posed, components.rest), 0.5);
}

TEST(ComponentPoser, EditsAddTheDifference) {
  const Bumps bumps = BumpClip(31, 2, 12);
  Clip clip = bumps.clip;
  for (std::size_t f = 0; f < clip.frames.size(); ++f) {
    clip.frames[f] = Moved(clip.frames[f], AxisAngle({0, 1, 0}, 0.5 * static_cast<double>(f)), {1, 0, 0});
  }
  clip.mesh.positions = clip.frames[0];
  const SparseComponents components = Decomposed(clip, Settings(4));
  const auto poser = MakePoser(components);
  MemoryClipReader reader(clip);
  std::unique_ptr<EditedClip> edited;
  ASSERT_TRUE(EditedClip::Create(reader, *poser, {}, edited).ok());
  Positions frame;
  bool end = false;
  for (const Positions& original : clip.frames) {
    ASSERT_TRUE(edited->Next(frame, end).ok());
    EXPECT_EQ(frame, original);
  }
  std::vector<ComponentEdit> edits(4);
  edits[2].gain = 2;
  edits[2].offset = 0.25;
  edits[2].curve.assign(12, 0.5f);
  ASSERT_TRUE(reader.Rewind().ok());
  ASSERT_TRUE(EditedClip::Create(reader, *poser, edits, edited).ok());
  std::vector<char> moves(frame.size(), 0);
  for (const std::uint32_t v : components.components[2].nodes) moves[v] = 1;
  const std::uint32_t centre = components.components[2].centre;
  for (std::size_t f = 0; f < 12; ++f) {
    ASSERT_TRUE(edited->Next(frame, end).ok());
    const double change = static_cast<double>(components.weight(f, 2)) + 0.75;
    const std::vector<double> height = HeightOf(components, 2);
    for (std::size_t v = 0; v < frame.size(); ++v) {
      if (moves[v] == 0) {
        EXPECT_EQ(frame[v], clip.frames[f][v]);
      }
    }
    EXPECT_NEAR(Distance({frame[centre]}, {clip.frames[f][centre]}), std::abs(change * height[centre]), 1e-4);
  }
}

TEST(ComponentPoser, Refuses) {
  const Bumps bumps = BumpClip(11, 2, 5);
  const SparseComponents good = Decomposed(bumps.clip, Settings(2));
  const auto expect = [](const SparseComponents& components, const std::string& message) {
    std::unique_ptr<ComponentPoser> poser;
    const Status status = ComponentPoser::Create(components, poser);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(status.message(), message);
    EXPECT_EQ(poser, nullptr);
  };
  SparseComponents bad = good;
  bad.triangles[0][1] = 121;
  expect(bad, "a triangle has a vertex that is not there");
  bad = good;
  bad.weights.pop_back();
  expect(bad, "the weights are not frames x components");
  bad = good;
  bad.components[1].nodes.back() = 121;
  expect(bad, "component 1: a node that is not there");
  bad = good;
  bad.components[0].values[1] = NAN;
  expect(bad, "component 0: a value is not finite");
  bad = good;
  bad.rest.clear();
  expect(bad, "the rest shape has no vertices");
  const auto poser = MakePoser(good);
  Positions posed;
  EXPECT_EQ(poser->Compose(std::vector<float>{1}, {}, posed).message(), "1 weights for 2 components");
  std::vector<float> weights;
  RigidPose pose;
  EXPECT_EQ(poser->Fit(Positions(3), weights, pose).message(), "3 vertices, not 121");
  const DragTarget drag{121, {}};
  EXPECT_EQ(poser->Drag({&drag, 1}, {}, weights).message(), "there is no vertex 121 among 121");
}

}  // namespace
}  // namespace sac

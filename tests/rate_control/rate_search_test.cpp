// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "codec/encode/quality.h"
#include "rate_control/target_search.h"
#include "synth/synth.h"

namespace sac {
namespace {

// A synthetic clip, its encodings and searches.
class SynthSource {
 public:
  SynthSource(SynthKind kind, std::uint32_t vertices, std::uint32_t frames) {
    EXPECT_TRUE(SynthClip::Create({kind, vertices, frames, 1}, clip_).ok());
  }

  // 0 harmonics: as many as the search likes.
  Status Search(const RateTargets& targets, Trial& best, std::uint32_t harmonics = 80) {
    EncoderSettings base;
    if (harmonics > 0) base.harmonics = harmonics;
    base.group = 20;
    trials = 0;
    const auto run = [this](Trial& trial) {
      ++trials;
      return RunTrial(clip_, trial);
    };
    return SearchTargets(targets, base, clip_.mesh(), run, best);
  }
  Trial Run(const EncoderSettings& settings) {
    Trial trial;
    trial.settings = settings;
    const Status status = RunTrial(clip_, trial);
    EXPECT_TRUE(status.ok()) << status.message();
    return trial;
  }

  int trials = 0;

 private:
  SynthClip clip_;
};

void ExpectReached(double figure, double target) {
  EXPECT_LE(figure, target);
  EXPECT_GE(figure, 0.95 * target);  // meshes as small as these scatter
}

struct Case {
  SynthKind kind;
  std::uint32_t vertices;
  std::array<double, 2> kg, sted, bpvf;
};
const std::array<Case, 2> kCases = {{{SynthKind::kFlag, 1200, {2.5, 0.5}, {0.05, 0.02}, {1, 4}},
                                     {SynthKind::kParts, 1000, {3, 0.5}, {0.06, 0.015}, {1, 3}}}};

TEST(RateSearch, ReachesEachTargetAlone) {
  for (const Case& c : kCases) {
    SynthSource clip(c.kind, c.vertices, 16);
    for (std::size_t i = 0; i < 2; ++i) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(c.kind) << " " << i);
      Trial best;
      Status status = clip.Search({c.kg[i], {}, {}}, best);
      ASSERT_TRUE(status.ok()) << status.message();
      ExpectReached(best.kg, c.kg[i]);
      EXPECT_LE(clip.trials, 24);
      status = clip.Search({{}, c.sted[i], {}}, best);
      ASSERT_TRUE(status.ok()) << status.message();
      ExpectReached(best.sted, c.sted[i]);
      EXPECT_LE(clip.trials, 24);
      status = clip.Search({{}, {}, c.bpvf[i]}, best);
      ASSERT_TRUE(status.ok()) << status.message();
      ExpectReached(best.bpvf, c.bpvf[i]);
      EXPECT_LE(clip.trials, 24);
    }
  }
}

// Coarse detail raises STED, which has two sides therefore.
TEST(RateSearch, StaysOnTheSmallSideOfDetail) {
  for (const auto& [kind, sted] : {std::pair{SynthKind::kParts, 0.06}, {SynthKind::kFlag, 0.04}}) {
    SynthSource clip(kind, 1000, 24);
    EncoderSettings settings;
    settings.harmonics = 80;
    settings.group = 20;
    Trial smooth;
    for (settings.quality = 0; settings.quality <= 60; settings.quality += 5) {
      smooth = clip.Run(settings);
      if (smooth.sted <= sted) break;
    }
    ASSERT_LE(smooth.sted, sted);
    Trial best;
    Status status = clip.Search({{}, sted, {}}, best);
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_LE(best.sted, sted);
    EXPECT_LE(static_cast<double>(best.bytes), 1.03 * static_cast<double>(smooth.bytes));
    status = clip.Search({smooth.kg, {}, {}}, best);
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_LE(best.kg, smooth.kg);
    EXPECT_LE(static_cast<double>(best.bytes), 1.02 * static_cast<double>(smooth.bytes));
  }
}

TEST(RateSearch, ChoosesHarmonicsUnlessTheyAreGiven) {
  SynthSource clip(SynthKind::kFlag, 1000, 16);
  Trial fixed, free;
  ASSERT_TRUE(clip.Search({1.0, {}, {}}, fixed, 40).ok());
  EXPECT_EQ(*fixed.settings.harmonics, 40u);
  ASSERT_TRUE(clip.Search({1.0, {}, {}}, free, 0).ok());
  EXPECT_GT(*free.settings.harmonics, 80u);
  EXPECT_LE(free.kg, 1.0);
  EXPECT_LT(free.bytes, fixed.bytes);
}

TEST(RateSearch, ReachesKgAndStedTogether) {
  for (const Case& c : kCases) {
    SynthSource clip(c.kind, c.vertices, 16);
    SCOPED_TRACE(static_cast<int>(c.kind));
    Trial kg_alone, best;
    ASSERT_TRUE(clip.Search({c.kg[0], {}, {}}, kg_alone).ok());
    for (const double factor : {0.7, 1.0, 1.2}) {
      const double sted = factor * kg_alone.sted;
      const Status status = clip.Search({c.kg[0], sted, {}}, best);
      ASSERT_TRUE(status.ok()) << status.message();
      EXPECT_LE(best.kg, c.kg[0]);
      EXPECT_LE(best.sted, sted);
      // Of parts this small, a harmonic more or less is one part's whole motion.
      EXPECT_GE(std::max(best.kg / c.kg[0], best.sted / sted), c.kind == SynthKind::kParts ? 0.75 : 0.95);
      EXPECT_LE(clip.trials, 24);
    }
  }
}

TEST(RateSearch, WhatWasMeasuredIsWhatTheSettingsGive) {
  SynthSource clip(SynthKind::kFlag, 300, 12);
  Trial best;
  ASSERT_TRUE(clip.Search({2.0, {}, {}}, best).ok());
  const Trial again = clip.Run(best.settings);
  EXPECT_EQ(again.bytes, best.bytes);
  EXPECT_EQ(again.kg, best.kg);
  EXPECT_EQ(again.sted, best.sted);
}

TEST(RateSearch, ASizeWithADistortionIsMetOrRefused) {
  SynthSource clip(SynthKind::kFlag, 300, 12);
  Trial best;
  ASSERT_TRUE(clip.Search({2.0, {}, {}}, best).ok());
  const double bpvf = best.bpvf;
  Trial roomy;
  ASSERT_TRUE(clip.Search({2.0, {}, 1.5 * bpvf}, roomy).ok());
  EXPECT_EQ(roomy.bytes, best.bytes);  // the smaller stream
  const Status tight = clip.Search({2.0, {}, 0.7 * bpvf}, best);
  EXPECT_EQ(tight.code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(tight.message().rfind("the targets exclude each other: KG ", 0), 0u) << tight.message();
}

TEST(RateSearch, SaysWhatCannotBeReached) {
  SynthSource clip(SynthKind::kFlag, 300, 4);
  Trial best;
  for (const RateTargets& targets : {RateTargets{1e-6, {}, {}}, {{}, 1e-6, {}}, {{}, {}, 0.01}}) {
    const Status status = clip.Search(targets, best);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(status.message().rfind("the target cannot be reached; nearest came KG ", 0), 0u) << status.message();
  }
  EXPECT_EQ(clip.Search({}, best).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(clip.Search({-1.0, {}, {}}, best).code(), StatusCode::kInvalidArgument);
}

// Encodes a clip at rising qualities and expects no error to rise.
void ExpectMonotone(SynthSource& clip, const std::vector<double>& qualities, EncoderSettings settings) {
  Trial last;
  for (const double quality : qualities) {
    settings.quality = quality;
    const Trial trial = clip.Run(settings);
    if (last.bytes > 0) {
      EXPECT_GT(trial.bytes, last.bytes) << quality;
      EXPECT_LE(trial.kg, last.kg) << quality;
      EXPECT_LE(trial.sted, last.sted) << quality;
    }
    last = trial;
  }
}

// Over all of the range, and closely where rows with more harmonics and with detail begin.
TEST(Quality, IsMonotone) {
  for (const SynthKind kind : {SynthKind::kWalker, SynthKind::kFlag}) {
    SynthSource clip(kind, 2000, 4);
    ExpectMonotone(clip, {0, 25, 50, 65, 78, 79, 90}, {});
  }
}

// A coarse detail plane would raise STED here, and few harmonics are no reason for one.
TEST(Quality, IsMonotoneInDenseMeshes) {
  SynthSource clip(SynthKind::kFlag, 8000, 3);
  EncoderSettings settings;
  settings.harmonics = 100;
  ExpectMonotone(clip, {60, 65, 79}, settings);
}

// The same motion of meshes with few and many vertices.
TEST(Quality, StedDoesNotDependOnTheDensity) {
  SynthSource sparse(SynthKind::kFlag, 1500, 3), dense(SynthKind::kFlag, 12'000, 3);
  EncoderSettings settings;
  settings.harmonics = 100;
  const double ratio = dense.Run(settings).sted / sparse.Run(settings).sted;
  EXPECT_GT(ratio, 1 / 1.3);
  EXPECT_LT(ratio, 1.3);
}

TEST(Quality, StepsNeverGrow) {
  for (const double most : {200.0, 500.0, 1000.0}) {
    OperatingPoint last = PointOfQuality(0, most);
    for (double quality = 0.5; quality <= 100; quality += 0.5) {
      const OperatingPoint s = PointOfQuality(quality, most);
      EXPECT_LE(s.motion_step, last.motion_step) << quality;
      EXPECT_LE(s.displacement_step, last.displacement_step) << quality;
      EXPECT_GE(s.position_bits, last.position_bits) << quality;
      EXPECT_GE(s.harmonics, last.harmonics) << quality;
      if (last.detail_step > 0) {
        EXPECT_GT(s.detail_step, 0) << quality;
        EXPECT_LE(s.detail_step, last.detail_step) << quality;
      }
      last = s;
    }
  }
}

// The same shape with edges half as long.
TEST(Quality, StepsFollowTheEdges) {
  const auto square = [](std::uint32_t cells) {
    Mesh mesh;
    for (std::uint32_t y = 0; y <= cells; ++y) {
      for (std::uint32_t x = 0; x <= cells; ++x) {
        mesh.positions.push_back(
            {static_cast<float>(x) / static_cast<float>(cells), static_cast<float>(y) / static_cast<float>(cells), 0});
        const std::uint32_t v = y * (cells + 1) + x;
        if (x < cells && y < cells) {
          mesh.triangles.push_back({v, v + 1, v + cells + 1});
          mesh.triangles.push_back({v + 1, v + cells + 2, v + cells + 1});
        }
      }
    }
    return mesh;
  };
  const EdgeScale coarse = EdgeScaleOf(square(64), 0.4), fine = EdgeScaleOf(square(128), 0.4);
  EXPECT_NEAR(coarse.median, 1.0 / 64 / 0.4, 1e-6);
  EXPECT_NEAR(fine.median, coarse.median / 2, 1e-6);
  EXPECT_NEAR(fine.more_bits - coarse.more_bits, 0.8, 1e-6);
  const double more = PointOfQuality(90, 200, fine).position_bits - PointOfQuality(90, 200).position_bits;
  EXPECT_NEAR(more, fine.more_bits, 1e-9);
  EXPECT_NEAR(PointOfQuality(90, 200, fine).detail_step, PointOfQuality(90, 200, coarse).detail_step / 2, 1e-9);
  Mesh point;
  point.positions = {{0, 0, 0}};
  EXPECT_EQ(EdgeScaleOf(point, 1).more_bits, 0);  // no edges
}

TEST(Quality, HarmonicsSuitTheMesh) {
  for (const std::uint32_t vertices : {1u, 300u, 3000u, 10'000u, 50'000u, 1'000'000u}) {
    const double most = MostHarmonics(vertices);
    EXPECT_GE(most, 200);
    EXPECT_LE(most, std::max(200.0, vertices / 9.0));
    for (double quality = 0; quality <= 100; quality += 0.5) {
      EXPECT_LE(PointOfQuality(quality, most).harmonics, most) << vertices << " " << quality;
      EXPECT_LE(SmoothPointOfQuality(quality, most).harmonics, most) << vertices << " " << quality;
      EXPECT_EQ(SmoothPointOfQuality(quality, most).detail_step, 0);
    }
    EXPECT_EQ(PointOfQuality(50, most).harmonics, 200);  // what starts quickly
  }
  EXPECT_GT(PointOfQuality(70, MostHarmonics(10'000)).harmonics, 500);
}

// Where decoders could not start in time with more harmonics, and where more would be one for a few vertices, the steps
// still become finer up to where detail sets in: coarse detail would make STED worse.
TEST(Quality, DoesWithoutCoarseDetail) {
  for (const std::uint32_t vertices : {400u, 3000u, 60'000u}) {
    const double most = MostHarmonics(vertices);
    OperatingPoint last = PointOfQuality(60, most);
    for (const double quality : {65.0, 70.0, 75.0, 78.0}) {
      const OperatingPoint s = PointOfQuality(quality, most);
      EXPECT_EQ(s.detail_step, 0) << quality;
      EXPECT_LT(s.displacement_step, last.displacement_step) << quality;
      last = s;
    }
  }
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
// Parts of unlike size keep an error in proportion to their own (spec.md 5.2, "Scales").
#include "codec/encode/part_scales.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "codec/encode/encoded_start.h"
#include "tests/test_clips.h"

namespace sac {
namespace {

constexpr float kFar = 1e5F;

// A clip, and two triangles that stand still far away.
Clip WithParked(Clip clip) {
  const auto add = [](Positions& positions) {
    positions.insert(positions.end(), {{kFar, 0, 0}, {kFar + 1, 0, 0}, {kFar, 1, 0}, {kFar, 0, 1}});
  };
  const auto n = static_cast<std::uint32_t>(clip.mesh.positions.size());
  clip.mesh.triangles.insert(clip.mesh.triangles.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
  add(clip.mesh.positions);
  for (Positions& frame : clip.frames) add(frame);
  return clip;
}

// The largest distance of a decoded vertex from its place, among the input's first `count`.
double MaxError(const Clip& clip, const Encoded& encoded, std::size_t count) {
  const Decoded decoded = Decode(encoded.bytes);
  EXPECT_TRUE(decoded.status.ok()) << decoded.status.message();
  EXPECT_EQ(decoded.frames.size(), clip.frames.size());
  double largest = 0;
  for (std::size_t f = 0; f < decoded.frames.size(); ++f) {
    for (std::size_t v = 0; v < encoded.order.size(); ++v) {
      const std::uint32_t i = encoded.order[v];
      if (i >= count) continue;
      double square = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        square += std::pow(double{decoded.frames[f].positions[v][a]} - clip.frames[f][i][a], 2);
      }
      largest = std::max(largest, std::sqrt(square));
    }
  }
  return largest;
}

EncoderSettings Reaching(std::optional<double> reach) {
  EncoderSettings settings;
  settings.quality = 60;
  settings.reach = reach;
  return settings;
}

TEST(PartScales, KeepTheErrorInProportion) {
  const Clip body = BendingClip(6), clip = WithParked(body);
  const std::size_t count = body.mesh.positions.size();
  const double alone = MaxError(body, Encode(body, Reaching({})), count);
  const double coarse = MaxError(clip, Encode(clip, Reaching({})), count);
  const double fine = MaxError(clip, Encode(clip, Reaching(5)), count);
  const double size = RmsRadius(body.mesh.positions);
  EXPECT_GT(coarse, size);
  EXPECT_LT(fine, 0.1 * size);
  EXPECT_LT(fine, 30 * alone);
}

TEST(PartScales, AreLeftOutWhereAllPartsAreLarge) {
  for (const Clip& clip : {BendingClip(3), TurningPartsClip(3)}) {
    EXPECT_EQ(Encode(clip, Reaching({})).bytes, Encode(clip, Reaching(1)).bytes);
  }
}

TEST(PartScales, GiveWayToTheReach) {
  const Clip clip = WithParked(BendingClip(1));
  const double rms = RmsRadius(clip.mesh.positions);
  const auto parts_of = [&](float reach) {
    return FindParts(clip.mesh, rms, 1e-3 * rms, std::vector<float>(clip.mesh.positions.size(), reach));
  };
  const MeshParts near = parts_of(1), far = parts_of(1e7F);
  ASSERT_EQ(near.scales.size(), 2u);
  EXPECT_GE(near.scales[0].exponent, 8u);
  EXPECT_LT(far.scales.empty() ? 0 : far.scales[0].exponent, near.scales[0].exponent);
  EXPECT_TRUE(parts_of(INFINITY).scales.empty());
}

// A small part that flies through the scene, as far as was said, is coded.
TEST(PartScales, FliersAreCoded) {
  Clip clip = WithParked(BendingClip(6));
  const std::size_t count = clip.mesh.positions.size() - 4;
  for (std::size_t f = 0; f < clip.frames.size(); ++f) {
    for (std::size_t v = 0; v < count; ++v) clip.frames[f][v][1] += 1.5e4F * static_cast<float>(f);
  }
  EncoderSettings settings = Reaching(8e4);
  settings.group = 2;
  const Encoded encoded = Encode(clip, settings);
  EXPECT_LT(MaxError(clip, encoded, count), 100);
}

TEST(PartScales, NegativeReachIsRefused) {
  const Clip clip = WithParked(BendingClip(1));
  std::unique_ptr<Encoder> encoder;
  EXPECT_EQ(Encoder::Create(clip.mesh, Reaching(-1), encoder).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(Encoder::Create(clip.mesh, Reaching(std::nan("")), encoder).code(), StatusCode::kInvalidArgument);
}

TEST(PartScales, AreInAStartThatIsReadAgain) {
  const Clip clip = WithParked(BendingClip(1));
  EncodedStart start, read;
  ASSERT_TRUE(EncodeStart(clip.mesh, Reaching(5), start).ok());
  ASSERT_FALSE(start.shape.factors.empty());
  ASSERT_TRUE(ReadStreamStart(WriteStreamStart(start), {}, read).ok());
  EXPECT_EQ(read.shape.factors, start.shape.factors);
  EXPECT_EQ(read.shape.positions, start.shape.positions);
}

}  // namespace
}  // namespace sac

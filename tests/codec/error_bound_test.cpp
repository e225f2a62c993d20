// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/error_bound.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <sstream>
#include <string>

#include "geometry/bounding_box.h"
#include "tests/test_clips.h"

namespace sac {
namespace {

void Shake(Positions& positions, double amplitude, std::mt19937& random) {
  for (Vec3f& p : positions) {
    for (float& x : p) x += static_cast<float>(amplitude * Signed(random));
  }
}

// Motion of all kinds that harmonics of the first frame cannot follow.
std::map<std::string, Clip> NastyClips() {
  std::mt19937 random(3);
  std::map<std::string, Clip> clips;
  clips["smooth"] = BendingClip(9);
  clips["parts"] = TurningPartsClip(9);
  Clip& noise = clips["noise"] = BendingClip(9);
  for (std::size_t t = 1; t < 9; ++t) Shake(noise.frames[t], 1, random);
  Clip& jumps = clips["jumps"] = BendingClip(9);
  for (std::size_t t = 1; t < 9; t += 2) {
    jumps.frames[t] = Moved(jumps.frames[t], Eigen::Matrix3d::Identity(), {5.0 * Signed(random), 0, 20});
  }
  Clip& wild = clips["single vertices thrown about"] = BendingClip(9);
  for (std::size_t t = 1; t < 9; ++t) wild.frames[t][7 * t] = {static_cast<float>(t), -9, 4};
  Clip& folded = clips["folded into a point and out"] = BendingClip(9);
  folded.frames[4].assign(folded.frames[4].size(), {1, 1, 1});
  Clip& growing = clips["growing, moving off"] = BendingClip(9);
  for (std::size_t t = 0; t < 9; ++t) {
    growing.frames[t] = Moved(growing.frames[t], (1.0 + static_cast<double>(t)) * Eigen::Matrix3d::Identity(),
                              {0.25 * static_cast<double>(t * t), 0, 0});
  }
  for (const double offset : {1e3, 1e6}) {
    Clip& far = clips["at " + std::to_string(offset)] = BendingClip(9);
    for (Positions& frame : far.frames) {
      frame = Moved(frame, Eigen::Matrix3d::Identity(), {offset, -offset / 3, offset});
    }
    far.mesh.positions = far.frames[0];
  }
  return clips;
}

// Encodes; `bytes` are complete if the status is ok.
Status TryEncode(const Clip& clip, const EncoderSettings& settings, Encoded& out) {
  std::unique_ptr<Encoder> encoder;
  SAC_RETURN_IF_ERROR(Encoder::Create(clip.mesh, settings, encoder));
  for (const Positions& frame : clip.frames) SAC_RETURN_IF_ERROR(encoder->Send(frame));
  SAC_RETURN_IF_ERROR(encoder->Finish());
  out.bytes = encoder->TakeBytes();
  out.order = encoder->order();
  return Status::Ok();
}

void ExpectHeld(const Clip& clip, const Encoded& encoded, double bound) {
  const Decoded decoded = Decode(encoded.bytes);
  ASSERT_EQ(decoded.frames.size(), clip.frames.size()) << decoded.status.message();
  for (std::size_t t = 0; t < clip.frames.size(); ++t) {
    EXPECT_LE(MaxDistance(clip.frames[t], decoded.frames[t].positions, encoded.order), bound) << "frame " << t;
  }
}

TEST(ErrorBound, HoldsForEveryDecodedFloat) {
  for (const auto& [name, clip] : NastyClips()) {
    const double diagonal = BoundingBox(clip.mesh.positions).diagonal();
    for (const double bound : {0.3, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 2e-7}) {
      for (const ReferenceShape reference : {ReferenceShape::kKey, ReferenceShape::kPrevious}) {
        SCOPED_TRACE(name + " " + std::to_string(bound));
        EncoderSettings settings;
        settings.max_error = bound * diagonal;
        settings.reference_shape = reference;
        settings.group = 5;
        if (*settings.max_error < LeastMaxError(clip.mesh.positions)) continue;
        Encoded encoded;
        const Status status = TryEncode(clip, settings, encoded);
        ASSERT_TRUE(status.ok()) << status.message();
        ExpectHeld(clip, encoded, *settings.max_error);
      }
    }
  }
}

// With steps that are too coarse for it the correction plane alone holds the bound.
TEST(ErrorBound, HoldsWithStepsThatDoNotHelp) {
  for (const auto& [name, clip] : NastyClips()) {
    SCOPED_TRACE(name);
    EncoderSettings settings;
    settings.max_error = std::max(1e-5, 10 * LeastMaxError(clip.mesh.positions));
    settings.detail_step = 0;
    settings.motion_step = 1;
    settings.displacement_step = 1;
    settings.position_bits = 3;
    Encoded encoded;
    const Status status = TryEncode(clip, settings, encoded);
    if (status.ok()) {
      ExpectHeld(clip, encoded, *settings.max_error);
    } else {
      EXPECT_NE(status.message().find("the smallest possible here is"), std::string::npos) << status.message();
    }
  }
}

TEST(ErrorBound, WhatCannotBeHeldIsRefusedWithWhatCan) {
  for (const auto& [name, clip] : NastyClips()) {
    SCOPED_TRACE(name);
    const double least = LeastMaxError(clip.mesh.positions);
    EncoderSettings settings;
    settings.max_error = 0.999 * least;
    Encoded encoded;
    const Status status = TryEncode(clip, settings, encoded);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    std::ostringstream number;
    number << least;
    EXPECT_NE(status.message().find("the smallest possible is " + number.str()), std::string::npos) << status.message();
  }
}

// A jump so far that neither the detail plane nor corrections reach across it.
TEST(ErrorBound, AFrameOutOfReachIsRefusedWithWhatCanBeHeld) {
  Clip clip = BendingClip(4);
  std::mt19937 random(1);
  Shake(clip.frames[2], 3e4, random);
  EncoderSettings settings;
  settings.max_error = 1e-5;
  Encoded encoded;
  Status status = TryEncode(clip, settings, encoded);
  ASSERT_EQ(status.code(), StatusCode::kInvalidArgument);
  const std::string text = "the smallest possible here is ";
  const std::size_t at = status.message().find(text);
  ASSERT_NE(at, std::string::npos) << status.message();
  settings.max_error = std::stod(status.message().substr(at + text.size()));
  status = TryEncode(clip, settings, encoded);
  ASSERT_TRUE(status.ok()) << status.message();
  ExpectHeld(clip, encoded, *settings.max_error);
}

TEST(ErrorBound, WhatStandsStillDoes) {
  Clip clip = BendingClip(12);
  std::mt19937 random(4);
  for (std::size_t t = 3; t < 12; ++t) Shake(clip.frames[t], 0.1, random);
  for (std::size_t t = 4; t < 10; ++t) clip.frames[t] = clip.frames[3];
  EncoderSettings settings;
  settings.max_error = 1e-3;
  settings.group = 7;
  const Encoded encoded = Encode(clip, settings);
  const Decoded decoded = Decode(encoded.bytes);
  ASSERT_EQ(decoded.frames.size(), 12u);
  for (std::size_t t = 4; t < 10; ++t) EXPECT_EQ(decoded.frames[t].positions, decoded.frames[3].positions) << t;
  ExpectHeld(clip, encoded, 1e-3);
}

TEST(ErrorBound, RoundingIsCountedIn) {
  const Eigen::RowVector3d exact(1, -1024, 0);
  EXPECT_EQ(DistanceAfterRounding(exact, {1e-8, 1e-5, 0}), 0);
  EXPECT_GE(DistanceAfterRounding(exact, {1e-7, 0, 0}), 1.19e-7);  // the next float
  std::mt19937 random(2);
  for (int i = 0; i < 10000; ++i) {
    Eigen::RowVector3d x, e;
    double distance = 0;
    for (Eigen::Index a = 0; a < 3; ++a) {
      x[a] = static_cast<double>(static_cast<float>(std::ldexp(Signed(random), static_cast<int>(random() % 20) - 10)));
      e[a] = std::ldexp(Signed(random), -static_cast<int>(random() % 20) - 10);
      const double decoded = static_cast<double>(static_cast<float>(x[a] + e[a]));
      distance += (decoded - x[a]) * (decoded - x[a]);
    }
    EXPECT_LE(std::sqrt(distance), DistanceAfterRounding(x, e));
  }
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
// Frames as matrices of handles.
#include <gtest/gtest.h>

#include <cmath>

#include "synth/synth.h"
#include "tests/codec/sought_clips.h"
#include "tests/test_clips.h"

namespace sac {
namespace {

Clip Flag(std::uint32_t frames) {
  SynthClip synth;
  EXPECT_TRUE(SynthClip::Create({SynthKind::kFlag, 900, frames, 1}, synth).ok());
  Clip clip{synth.mesh(), {}};
  for (std::uint32_t f = 0; f < frames; ++f) clip.frames.push_back(synth.Frame(f));
  return clip;
}

// The positions that matrices give.
Positions Blended(const Mesh& mesh, const BlendWeights& weights, const std::vector<float>& matrices) {
  Positions out(mesh.positions.size());
  for (std::size_t v = 0; v < out.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      double x = 0;
      for (std::uint32_t i = weights.first[v]; i < weights.first[v + 1]; ++i) {
        const float* row = matrices.data() + 12 * weights.handles[i] + 4 * a;
        double moved = static_cast<double>(row[3]);
        for (std::size_t k = 0; k < 3; ++k)
          moved += static_cast<double>(row[k]) * static_cast<double>(mesh.positions[v][k]);
        x += static_cast<double>(weights.weights[i]) * moved;
      }
      out[v][a] = static_cast<float>(x);
    }
  }
  return out;
}

void ExpectClose(const Positions& a, const Positions& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t v = 0; v < a.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(static_cast<double>(a[v][c]), static_cast<double>(b[v][c]), tolerance) << v;
    }
  }
}

TEST(HandleOutput, BlendsToThePositions) {
  EncoderSettings every = Grouped();
  every.handles_per_harmonic = 0;
  for (const Clip& clip : {BendingClip(kFrames), TurningPartsClip(kFrames), Flag(kFrames)}) {
    for (const EncoderSettings& settings : {Grouped(), every}) {
      const Bytes stream = Encode(clip, settings).bytes;
      const Decoded whole = Decode(stream);
      Decoder decoder;
      BlendWeights weights;
      EXPECT_EQ(decoder.Blend(weights).code(), StatusCode::kNeedMoreData);
      std::vector<float> matrices;
      FrameInfo info;
      std::uint32_t frames = 0;
      bool exact = false;
      for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
        ASSERT_TRUE(decoder.Send(rest).ok());
        if (decoder.mesh() == nullptr) continue;
        if (matrices.empty()) {
          ASSERT_TRUE(decoder.Blend(weights).ok());
          matrices.resize(12 * weights.handle_count);
        }
        while (decoder.ReceiveHandles(matrices, info, exact).ok()) {
          EXPECT_TRUE(exact);
          EXPECT_EQ(info.index, frames);
          const Positions blended = Blended(*decoder.mesh(), weights, matrices);
          ExpectClose(blended, whole.frames[frames].positions, 2e-5);
          for (const Vec3f& p : blended) {
            for (std::size_t a = 0; a < 3; ++a) {
              EXPECT_GE(static_cast<double>(p[a]), info.box.low[a] - 1e-4);
              EXPECT_LE(static_cast<double>(p[a]), info.box.high[a] + 1e-4);
            }
          }
          ++frames;
        }
      }
      EXPECT_EQ(frames, kFrames);
      EXPECT_TRUE(decoder.Finish().ok());
      EXPECT_EQ(weights.first.size(), decoder.mesh()->positions.size() + 1);
      for (std::size_t v = 0; v + 1 < weights.first.size(); ++v) {
        double sum = 0;
        for (std::uint32_t i = weights.first[v]; i < weights.first[v + 1]; ++i) {
          EXPECT_GT(weights.weights[i], 0);
          sum += static_cast<double>(weights.weights[i]);
        }
        EXPECT_NEAR(sum, 1, 1e-6);
      }
    }
  }
}

TEST(HandleOutput, SaysWhenDetailIsLeftOut) {
  EncoderSettings settings = Grouped();
  settings.detail_step = 0.002;
  const Bytes stream = Encode(Flag(6), settings).bytes;
  Decoder decoder;
  BlendWeights weights;
  bool any = false;
  for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
    ASSERT_TRUE(decoder.Send(rest).ok());
    if (decoder.mesh() == nullptr) continue;
    ASSERT_TRUE(decoder.Blend(weights).ok());
    std::vector<float> matrices(12 * weights.handle_count);
    FrameInfo info;
    bool exact = true;
    while (decoder.ReceiveHandles(matrices, info, exact).ok()) any = any || !exact;
  }
  EXPECT_TRUE(any);
}

TEST(HandleOutput, InterpolatesAsPositionsDo) {
  const Bytes stream = Encode(BendingClip(kFrames), Grouped()).bytes;
  Decoder by_positions, by_handles;
  std::span<const std::uint8_t> a(stream), b(stream);
  BlendWeights weights;
  std::vector<float> matrices;
  DecodedFrame frame;
  FrameInfo info;
  bool exact = false;
  for (double time = 0.25; time < kFrames - 1; time += 1.5) {
    Status status;
    while ((status = by_positions.Interpolate(time, frame)).code() == StatusCode::kNeedMoreData) {
      ASSERT_TRUE(by_positions.Send(a).ok());
    }
    ASSERT_TRUE(status.ok());
    while (by_handles.mesh() == nullptr) ASSERT_TRUE(by_handles.Send(b).ok());
    ASSERT_TRUE(by_handles.Blend(weights).ok());
    matrices.resize(12 * weights.handle_count);
    while ((status = by_handles.InterpolateHandles(time, matrices, info, exact)).code() == StatusCode::kNeedMoreData) {
      ASSERT_TRUE(by_handles.Send(b).ok());
    }
    ASSERT_TRUE(status.ok()) << status.message();
    ExpectClose(Blended(*by_handles.mesh(), weights, matrices), frame.positions, 2e-5);
  }
}

TEST(HandleOutput, RoomOfAnotherSizeIsRefusedAndTheFrameWaits) {
  const Bytes stream = Encode(BendingClip(3), Grouped()).bytes;
  Decoder decoder;
  std::span<const std::uint8_t> rest(stream);
  while (decoder.mesh() == nullptr) ASSERT_TRUE(decoder.Send(rest).ok());
  BlendWeights weights;
  ASSERT_TRUE(decoder.Blend(weights).ok());
  ASSERT_TRUE(decoder.Send(rest).ok());
  std::vector<float> matrices(12 * weights.handle_count - 1);
  FrameInfo info;
  bool exact = false;
  EXPECT_EQ(decoder.ReceiveHandles(matrices, info, exact).code(), StatusCode::kInvalidArgument);
  matrices.push_back(0);
  EXPECT_TRUE(decoder.ReceiveHandles(matrices, info, exact).ok());
  EXPECT_EQ(info.index, 0u);
}

TEST(HandleOutput, FramesAgainstTheFrameBeforeHaveNone) {
  EncoderSettings settings = Grouped();
  settings.reference_shape = ReferenceShape::kPrevious;
  const Bytes stream = Encode(BendingClip(3), settings).bytes;
  Decoder decoder;
  std::span<const std::uint8_t> rest(stream);
  while (decoder.mesh() == nullptr) ASSERT_TRUE(decoder.Send(rest).ok());
  BlendWeights weights;
  EXPECT_EQ(decoder.Blend(weights).code(), StatusCode::kUnsupported);
  DecodedFrame frame;
  ASSERT_TRUE(decoder.Send(rest).ok());
  EXPECT_TRUE(decoder.Receive(frame).ok());
}

}  // namespace
}  // namespace sac

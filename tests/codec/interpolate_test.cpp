// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/codec/sought_clips.h"
#include "tests/test_clips.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

TEST(Interpolate, IsBetweenItsFrames) {
  const Bytes stream = Encode(BendingClip(kFrames), Grouped()).bytes;
  const Decoded whole = Decode(stream);
  Decoder decoder;
  DecodedFrame frame;
  std::span<const std::uint8_t> rest(stream);
  for (double time = 0; time <= kFrames - 1; time += 0.25) {
    Status status;
    while ((status = decoder.Interpolate(time, frame)).code() == StatusCode::kNeedMoreData) {
      ASSERT_FALSE(rest.empty()) << time;
      ASSERT_TRUE(decoder.Send(rest).ok());
    }
    ASSERT_TRUE(status.ok()) << time << ": " << status.message();
    EXPECT_DOUBLE_EQ(frame.time, time / 25);
    const auto at = static_cast<std::size_t>(time);
    EXPECT_EQ(frame.index, at);
    const Positions &a = whole.frames[at].positions,
                    &b = whole.frames[std::min<std::size_t>(at + 1, kFrames - 1)].positions;
    const double t = time - static_cast<double>(at), step = (ToMatrix(a) - ToMatrix(b)).norm();
    const double miss = (ToMatrix(frame.positions) - (1 - t) * ToMatrix(a) - t * ToMatrix(b)).norm();
    EXPECT_LE(miss, t == 0 ? 1e-5 : 0.3 * step + 0.02) << time;
  }
  // The last frame is held for its time; what is gone is gone, until it is sought.
  EXPECT_EQ(decoder.Interpolate(kFrames, frame).code(), StatusCode::kNeedMoreData);
  while (!rest.empty()) ASSERT_TRUE(decoder.Send(rest).ok());
  EXPECT_EQ(decoder.frames(), kFrames);
  EXPECT_TRUE(decoder.Interpolate(kFrames - 0.25, frame).ok());
  EXPECT_EQ(frame.index, kFrames - 1);
  EXPECT_EQ(frame.positions, whole.frames.back().positions);
  EXPECT_EQ(decoder.Interpolate(kFrames, frame).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(decoder.Interpolate(3.5, frame).code(), StatusCode::kInvalidArgument);
  std::uint64_t byte = 0;
  ASSERT_TRUE(decoder.Seek(3, byte).ok());
  rest = std::span(stream).subspan(byte);
  Status status;
  while ((status = decoder.Interpolate(3.5, frame)).code() == StatusCode::kNeedMoreData && !rest.empty()) {
    ASSERT_TRUE(decoder.Send(rest).ok());
  }
  EXPECT_TRUE(status.ok()) << status.message();
  for (const double no_time : {-0.5, 1e300, std::nan("")}) {
    EXPECT_EQ(decoder.Interpolate(no_time, frame).code(), StatusCode::kInvalidArgument);
  }
}

TEST(Interpolate, KeepsTheSizeOfWhatTurns) {
  Clip clip = BendingClip(1);
  const Positions first = clip.frames[0];
  for (int i = 1; i < 4; ++i) {
    Positions& turned = clip.frames.emplace_back(first);
    const double angle = 0.9 * i;
    for (std::size_t v = 0; v < first.size(); ++v) {
      const double x = static_cast<double>(first[v][0]), y = static_cast<double>(first[v][1]);
      turned[v] = {static_cast<float>(x * std::cos(angle) - y * std::sin(angle)),
                   static_cast<float>(x * std::sin(angle) + y * std::cos(angle)), first[v][2]};
    }
  }
  const Bytes stream = Encode(clip, Grouped()).bytes;
  const Decoded whole = Decode(stream);
  Decoder decoder;
  DecodedFrame frame;
  for (std::span<const std::uint8_t> rest(stream);
       decoder.Interpolate(1.5, frame).code() == StatusCode::kNeedMoreData;) {
    ASSERT_TRUE(decoder.Send(rest).ok());
  }
  const double size = RmsRadius(whole.frames[1].positions);
  EXPECT_NEAR(RmsRadius(frame.positions), size, 0.01 * size);  // the mean of positions would be 10 % smaller
}

// Rotations are unwrapped within a group: from one to the next, their vectors may be turns apart.
TEST(Interpolate, TurnsTheShortWayBetweenGroups) {
  constexpr double kTurn = 0.7;
  const Clip still = BendingClip(1);
  Clip clip{still.mesh, {}};
  for (std::uint32_t t = 0; t < kFrames; ++t) {
    clip.frames.push_back(Moved(still.frames[0], AxisAngle({1, 2, 3}, kTurn * t), Eigen::Vector3d(0.1 * t, 0, 0)));
  }
  const Bytes stream = Encode(clip, Grouped()).bytes;
  const Decoded whole = Decode(stream);
  Decoder decoder;
  std::span<const std::uint8_t> rest(stream);
  for (double time = 0.5; time < kFrames - 1; time += 1) {
    DecodedFrame frame;
    while (decoder.Interpolate(time, frame).code() == StatusCode::kNeedMoreData) {
      ASSERT_TRUE(decoder.Send(rest).ok());
    }
    const auto at = static_cast<std::size_t>(time);
    const double before = (ToMatrix(frame.positions) - ToMatrix(whole.frames[at].positions)).norm(),
                 after = (ToMatrix(frame.positions) - ToMatrix(whole.frames[at + 1].positions)).norm(),
                 step = (ToMatrix(whole.frames[at + 1].positions) - ToMatrix(whole.frames[at].positions)).norm();
    EXPECT_NEAR(before, step / 2, 0.05 * step) << time;
    EXPECT_NEAR(after, step / 2, 0.05 * step) << time;
  }
}

TEST(Interpolate, TellsLostFromGone) {
  Bytes stream = Encode(BendingClip(kFrames), Grouped()).bytes;
  const std::vector<Packet> packets = Packets(stream);
  std::size_t end = 4;  // of the second group
  for (std::size_t i = 0; i < 4; ++i) end += PacketSize(packets[i].payload.size());
  stream[end - 1] ^= 1;
  DecoderSettings settings;
  settings.skip_damage = true;
  Decoder decoder(settings);
  DecodedFrame frame;
  ReadOn(decoder, stream, 0);
  for (const double time : {4.5, 5.0, 7.5, 9.5}) {
    EXPECT_EQ(decoder.Interpolate(time, frame).code(), StatusCode::kCorrupt) << time;
  }
  for (const double time : {1.0, 3.5, 10.0, 12.5}) {
    EXPECT_EQ(decoder.Interpolate(time, frame).code(), StatusCode::kInvalidArgument) << time;
  }
  EXPECT_TRUE(decoder.Interpolate(21.5, frame).ok());
}

TEST(Interpolate, FramesBeforeCountAsReceived) {
  const Bytes stream = Encode(BendingClip(kFrames), Grouped()).bytes;
  Decoder decoder;
  DecodedFrame frame;
  std::span<const std::uint8_t> rest(stream);
  while (decoder.Interpolate(2.5, frame).code() == StatusCode::kNeedMoreData) ASSERT_TRUE(decoder.Send(rest).ok());
  ASSERT_TRUE(decoder.Receive(frame).ok());
  EXPECT_EQ(frame.index, 3u);
  std::uint64_t byte = 0;
  ASSERT_TRUE(decoder.Seek(0, byte).ok());
  ASSERT_TRUE(decoder.Interpolate(1, frame).ok());  // of the group that it still has
  rest = std::span(stream).subspan(byte);
  ASSERT_TRUE(decoder.Send(rest).ok());
  ASSERT_TRUE(decoder.Receive(frame).ok());
  EXPECT_EQ(frame.index, 1u);
}

TEST(Interpolate, NotAgainstTheFrameBefore) {
  EncoderSettings settings = Grouped();
  settings.reference_shape = ReferenceShape::kPrevious;
  const Bytes stream = Encode(BendingClip(5), settings).bytes;
  Decoder decoder;
  DecodedFrame frame;
  ReadOn(decoder, stream, 0, 1);
  EXPECT_EQ(decoder.Interpolate(0.5, frame).code(), StatusCode::kUnsupported);
}

}  // namespace
}  // namespace sac

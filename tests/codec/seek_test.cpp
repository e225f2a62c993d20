// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "format/stream_index.h"
#include "tests/codec/sought_clips.h"
#include "tests/test_clips.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

// Streams of all kinds of groups.
std::vector<Bytes> Streams() {
  const Clip clip = BendingClip(kFrames);
  EncoderSettings detail = Grouped(), low_delay = Grouped(), previous = Grouped(), repeated = Grouped();
  detail.detail_step = 0.01;
  detail.max_error = 0.02;
  low_delay.low_delay = true;
  previous.reference_shape = ReferenceShape::kPrevious;
  repeated.repeat_start = 2;
  EncoderSettings both = low_delay;
  both.reference_shape = ReferenceShape::kPrevious;
  std::vector<Bytes> streams;
  for (const EncoderSettings& s : {Grouped(), detail, low_delay, previous, repeated, both}) {
    streams.push_back(Encode(clip, s).bytes);
  }
  return streams;
}

// The order of summation may differ, so that some last bits do.
void ExpectNear(const Positions& a, const Positions& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t v = 0; v < a.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(a[v][c], b[v][c], 1e-6) << v;
  }
}

TEST(Seek, GivesWhatStraightDecodingGives) {
  for (const Bytes& stream : Streams()) {
    const Decoded whole = Decode(stream);
    ASSERT_EQ(whole.frames.size(), kFrames);
    Decoder decoder;
    std::uint64_t byte = 0;
    EXPECT_EQ(decoder.Seek(0, byte).code(), StatusCode::kNeedMoreData);
    ReadOn(decoder, stream, 0);
    for (std::uint32_t i = 0; i < kFrames; ++i) {
      const std::uint32_t frame = (i * 7 + 3) % kFrames;  // back and forth
      ASSERT_TRUE(decoder.Seek(frame, byte).ok());
      const std::vector<DecodedFrame> frames = ReadOn(decoder, stream, byte);
      ASSERT_EQ(frames.size(), kFrames - frame);
      for (std::size_t t = 0; t < frames.size(); ++t) {
        EXPECT_EQ(frames[t].index, frame + t);
        EXPECT_EQ(frames[t].intra, whole.frames[frame + t].intra);
        ExpectNear(frames[t].positions, whole.frames[frame + t].positions);
      }
      EXPECT_TRUE(decoder.Finish().ok());
    }
    EXPECT_EQ(decoder.Seek(kFrames, byte).code(), StatusCode::kInvalidArgument);
  }
}

// A group that was read last is not parsed again; but other bytes in its place are.
TEST(Seek, WithinAGroup) {
  for (const ReferenceShape reference : {ReferenceShape::kKey, ReferenceShape::kPrevious}) {
    EncoderSettings settings = Grouped();
    settings.reference_shape = reference;
    const Bytes stream = Encode(BendingClip(kFrames), settings).bytes;
    const Decoded whole = Decode(stream);
    Decoder decoder;
    std::uint64_t byte = 0;
    ReadOn(decoder, stream, 0, 8);
    for (const std::uint32_t wanted : {9u, 5u, 8u, 6u}) {  // of the second group
      ASSERT_TRUE(decoder.Seek(wanted, byte).ok());
      const std::vector<DecodedFrame> frames = ReadOn(decoder, stream, byte, 1);
      ASSERT_EQ(frames.size(), 1u);
      EXPECT_EQ(frames[0].index, wanted);
      ExpectNear(frames[0].positions, whole.frames[wanted].positions);
    }
    ASSERT_TRUE(decoder.Seek(6, byte).ok());
    std::vector<Packet> packets = Packets(stream);
    packets[3].payload = packets[2].payload;  // the first group again
    const Bytes other = Join(packets);
    for (std::span<const std::uint8_t> rest = std::span(other).subspan(byte); !rest.empty();) {
      if (!decoder.Send(rest).ok()) break;
      DecodedFrame frame;
      if (!decoder.Receive(frame).ok()) continue;
      EXPECT_NE(frame.index, 6u);
    }
  }
}

TEST(Seek, NeedsNoIndex) {
  EncoderSettings settings = Grouped();
  settings.index = false;
  const Bytes stream = Encode(BendingClip(kFrames), settings).bytes;
  const Decoded whole = Decode(stream);
  Decoder decoder;
  ASSERT_EQ(ReadOn(decoder, stream, 0, 1).size(), 1u);
  std::uint64_t byte = 0;
  ASSERT_TRUE(decoder.Seek(17, byte).ok());
  const std::vector<DecodedFrame> frames = ReadOn(decoder, stream, byte);
  ASSERT_EQ(frames.size(), kFrames - 17);
  ExpectNear(frames[0].positions, whole.frames[17].positions);
  // Now it knows.
  std::uint64_t again = 0;
  ASSERT_TRUE(decoder.Seek(17, again).ok());
  EXPECT_GT(again, byte);
}

TEST(Seek, TheIndexSaysWhere) {
  const Bytes stream = Encode(BendingClip(kFrames), Grouped()).bytes;
  const std::vector<Packet> packets = Packets(stream);
  Decoder decoder;
  ReadOn(decoder, stream, 0, 1);
  std::size_t needed = 0;
  const auto tail = [&](std::size_t size) { return std::span(stream).last(size); };
  EXPECT_EQ(decoder.AddIndex(tail(3), needed).code(), StatusCode::kNeedMoreData);
  ASSERT_EQ(needed, kStreamTail);
  EXPECT_EQ(decoder.AddIndex(tail(needed), needed).code(), StatusCode::kNeedMoreData);
  EXPECT_EQ(needed, PacketSize(packets.back().payload.size()));
  EXPECT_EQ(decoder.AddIndex(tail(needed - 1), needed).code(), StatusCode::kNeedMoreData);
  ASSERT_TRUE(decoder.AddIndex(tail(needed), needed).ok());
  std::uint64_t group = 4;
  for (std::size_t i = 0; i < 2 + 3; ++i) group += PacketSize(packets[i].payload.size());
  std::uint64_t byte = 0;
  ASSERT_TRUE(decoder.Seek(17, byte).ok());
  EXPECT_EQ(byte, group);  // the fourth, of frames 15 to 19
  EXPECT_EQ(ReadOn(decoder, stream, byte).size(), kFrames - 17);
  EXPECT_EQ(decoder.Seek(kFrames, byte).code(), StatusCode::kInvalidArgument);
  // A larger tail will do, one without an index not.
  EXPECT_TRUE(decoder.AddIndex(stream, needed).ok());
  EXPECT_FALSE(decoder.AddIndex(std::span(stream).first(stream.size() - 1), needed).ok());
  const Bytes short_clip = Encode(BendingClip(3), Grouped()).bytes;
  EXPECT_FALSE(decoder.AddIndex(short_clip, needed).ok());
  EXPECT_TRUE(needed > short_clip.size() || needed == kStreamTail);
}

TEST(Seek, ByTime) {
  const Bytes stream = Encode(BendingClip(kFrames), Grouped()).bytes;
  Decoder decoder;
  std::vector<DecodedFrame> frames = ReadOn(decoder, stream, 0);
  EXPECT_DOUBLE_EQ(frames[7].time, 7 / 25.0);
  std::uint64_t byte = 0;
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    ASSERT_TRUE(decoder.SeekTime(i / 25.0, byte).ok());
    EXPECT_EQ(ReadOn(decoder, stream, byte, 1).at(0).index, i);
    ASSERT_TRUE(decoder.SeekTime((i + 0.9) / 25.0, byte).ok());
    EXPECT_EQ(ReadOn(decoder, stream, byte, 1).at(0).index, i);
  }
  for (const double no_time : {-1.0, 1e12, std::nan("")}) {
    EXPECT_EQ(decoder.SeekTime(no_time, byte).code(), StatusCode::kInvalidArgument) << no_time;
  }
  EncoderSettings timeless = Grouped();
  timeless.frame_rate_numerator = 0;
  Decoder other;
  frames = ReadOn(other, Encode(BendingClip(3), timeless).bytes, 0);
  EXPECT_EQ(frames[2].time, 0);
  EXPECT_EQ(other.SeekTime(0, byte).code(), StatusCode::kInvalidArgument);
}

TEST(Seek, AnotherStreamAfterReset) {
  const std::vector<Bytes> streams = Streams();
  Decoder decoder;
  for (const Bytes& stream : streams) {
    ReadOn(decoder, stream, 0, 3);
    decoder.Reset();
    EXPECT_EQ(decoder.mesh(), nullptr);
  }
  EXPECT_EQ(ReadOn(decoder, streams[0], 0).size(), kFrames);
}

TEST(Seek, GoesOnAfterAnError) {
  const Bytes stream = Encode(BendingClip(kFrames), Grouped()).bytes;
  Bytes damaged = stream;
  damaged[damaged.size() - 60] ^= 1;
  Decoder decoder;
  std::span<const std::uint8_t> rest(damaged);
  Status status;
  for (DecodedFrame frame; status.ok() && !rest.empty(); status = decoder.Send(rest)) {
    while (decoder.Receive(frame).ok()) {
    }
  }
  EXPECT_EQ(status.code(), StatusCode::kCorrupt);
  std::uint64_t byte = 0;
  ASSERT_TRUE(decoder.Seek(2, byte).ok());
  EXPECT_EQ(ReadOn(decoder, stream, byte).size(), kFrames - 2);
}

TEST(Seek, AFractionOfTheFrames) {
  for (const Bytes& stream : Streams()) {
    const Decoded whole = Decode(stream);
    for (const std::uint32_t step : {2u, 3u, 7u, 100u}) {
      DecoderSettings settings;
      settings.frame_step = step;
      const Decoded some = Decode(stream, stream.size(), settings);
      ASSERT_TRUE(some.status.ok());
      ASSERT_EQ(some.frames.size(), (kFrames + step - 1) / step);
      for (std::size_t i = 0; i < some.frames.size(); ++i) {
        EXPECT_EQ(some.frames[i].index, i * step);
        ExpectNear(some.frames[i].positions, whole.frames[i * step].positions);
      }
    }
  }
}

TEST(Seek, ThreadsMakeNoDifference) {
  for (const Bytes& stream : Streams()) {
    const Decoded one = Decode(stream);
    for (const unsigned threads : {2u, 3u, 8u}) {
      DecoderSettings settings;
      settings.threads = threads;
      settings.frame_step = threads == 3 ? 2 : 1;
      const Decoded many = Decode(stream, stream.size(), settings);
      ASSERT_TRUE(many.status.ok()) << many.status.message();
      ASSERT_EQ(many.frames.size(), (kFrames + settings.frame_step - 1) / settings.frame_step);
      for (const DecodedFrame& frame : many.frames) ExpectNear(frame.positions, one.frames[frame.index].positions);
    }
  }
}

TEST(Seek, ThreadsPlayAgain) {
  for (const Bytes& stream : Streams()) {
    const Decoded whole = Decode(stream);
    DecoderSettings settings;
    settings.threads = 3;
    Decoder decoder(settings);
    ReadOn(decoder, stream, 0);
    for (const std::uint32_t frame : {0u, 21u, 22u, 21u, 3u, 3u}) {
      std::uint64_t byte = 0;
      ASSERT_TRUE(decoder.Seek(frame, byte).ok());
      const std::vector<DecodedFrame> frames = ReadOn(decoder, stream, byte, frame == 3 ? 1 : 1000);
      ASSERT_EQ(frames.size(), frame == 3 ? 1 : kFrames - frame);
      for (const DecodedFrame& f : frames) ExpectNear(f.positions, whole.frames[f.index].positions);
    }
  }
}

TEST(Seek, NoStepIsNone) {
  DecoderSettings settings;
  settings.frame_step = 0;
  Decoder decoder(settings);
  const Bytes stream = Encode(BendingClip(1), Grouped()).bytes;
  std::span<const std::uint8_t> rest(stream);
  EXPECT_EQ(decoder.Send(rest).code(), StatusCode::kInvalidArgument);
}

// The shape half way between two frames is near their mean where little happens, and keeps its size where it turns.
}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
// Streams of several meshes (spec.md 3).
#include <gtest/gtest.h>

#include "format/group.h"
#include "format/stream_index.h"
#include "tests/codec/sought_clips.h"
#include "tests/test_clips.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

constexpr std::uint32_t kSegment = 11;  // frames of each of the three

Clip OtherClip(std::uint32_t frames) { return TurningPartsClip(frames); }

// Two meshes in three segments.
Bytes Segmented(EncoderSettings settings = Grouped()) {
  settings.harmonics.reset();
  settings.quality = 30;
  const Clip first = BendingClip(kSegment), second = OtherClip(kSegment);
  std::unique_ptr<Encoder> encoder;
  EXPECT_TRUE(Encoder::Create(first.mesh, settings, encoder).ok());
  for (const Positions& frame : first.frames) EXPECT_TRUE(encoder->Send(frame).ok());
  EXPECT_TRUE(encoder->BeginSegment(second.mesh).ok());
  EXPECT_EQ(encoder->order().size(), second.mesh.positions.size());
  for (const Positions& frame : second.frames) EXPECT_TRUE(encoder->Send(frame).ok());
  EXPECT_TRUE(encoder->BeginSegment(first.mesh).ok());
  for (const Positions& frame : first.frames) EXPECT_TRUE(encoder->Send(frame).ok());
  EXPECT_TRUE(encoder->Finish().ok());
  return encoder->TakeBytes();
}

// What each segment is as a stream of its own.
std::vector<DecodedFrame> Alone(std::uint32_t segment, EncoderSettings settings = Grouped()) {
  settings.harmonics.reset();
  settings.quality = 30;
  return Decode(Encode(segment == 1 ? OtherClip(kSegment) : BendingClip(kSegment), settings).bytes).frames;
}

TEST(Segments, AreDecodedAsStreamsOfTheirOwn) {
  EncoderSettings low_delay = Grouped(), repeated = Grouped(), layered = Grouped();
  low_delay.low_delay = true;
  repeated.repeat_start = 1;
  layered.base_levels = 1;
  for (const EncoderSettings& settings : {Grouped(), low_delay, repeated, layered}) {
    for (const std::size_t chunk : {std::size_t{1}, std::size_t{100}, std::size_t{1} << 20}) {
      const Decoded got = Decode(Segmented(settings), chunk);
      ASSERT_TRUE(got.status.ok()) << got.status.message();
      ASSERT_EQ(got.frames.size(), 3 * kSegment);
      for (std::uint32_t s = 0; s < 3; ++s) {
        const std::vector<DecodedFrame> alone = Alone(s, settings);
        for (std::uint32_t t = 0; t < kSegment; ++t) {
          const DecodedFrame& frame = got.frames[s * kSegment + t];
          EXPECT_EQ(frame.index, s * kSegment + t);
          EXPECT_EQ(frame.segment, s);
          EXPECT_EQ(frame.positions, alone[t].positions) << s << " " << t;
        }
      }
    }
  }
}

TEST(Segments, TheMeshChangesBeforeItsFirstFrame) {
  const Bytes stream = Segmented();
  const Mesh first = Decode(Encode(BendingClip(1), Grouped()).bytes).mesh;
  Decoder decoder;
  std::uint32_t changes = 0, segment = 0;
  for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
    ASSERT_TRUE(decoder.Send(rest).ok());
    if (decoder.segment().value_or(0) != segment) {
      ++changes;
      segment = *decoder.segment();
    }
    for (DecodedFrame frame; decoder.Receive(frame).ok();) {
      EXPECT_EQ(frame.segment, segment);
      EXPECT_EQ(frame.positions.size(), decoder.mesh()->positions.size());
    }
  }
  EXPECT_EQ(changes, 2u);
}

TEST(Segments, SeekFindsTheStartThatAFrameNeeds) {
  const Bytes stream = Segmented();
  const Decoded whole = Decode(stream);
  for (const bool with_index : {false, true}) {
    Decoder decoder;
    std::size_t needed = 0;
    if (with_index) {
      std::span<const std::uint8_t> head(stream);
      while (decoder.mesh() == nullptr) ASSERT_TRUE(decoder.Send(head).ok());
      ASSERT_EQ(decoder.AddIndex(std::span(stream).last(8), needed).code(), StatusCode::kNeedMoreData);
      ASSERT_TRUE(decoder.AddIndex(std::span(stream).last(needed), needed).ok());
    } else {
      ReadOn(decoder, stream, 0);
    }
    for (std::uint32_t i = 0; i < 3 * kSegment; ++i) {
      const std::uint32_t frame = (i * 13 + 5) % (3 * kSegment);  // back and forth
      std::uint64_t byte = 0;
      ASSERT_TRUE(decoder.Seek(frame, byte).ok());
      const std::vector<DecodedFrame> frames = ReadOn(decoder, stream, byte, 2);
      ASSERT_FALSE(frames.empty()) << frame;
      EXPECT_EQ(frames[0].index, frame);
      EXPECT_EQ(frames[0].segment, frame / kSegment);
      ASSERT_EQ(frames[0].positions.size(), whole.frames[frame].positions.size());
      for (std::size_t v = 0; v < frames[0].positions.size(); ++v) {
        ASSERT_NEAR(frames[0].positions[v][0], whole.frames[frame].positions[v][0], 1e-6);
      }
    }
  }
}

TEST(Segments, NothingIsInterpolatedAcross) {
  const Bytes stream = Segmented();
  const Decoded whole = Decode(stream);
  Decoder decoder;
  std::span<const std::uint8_t> rest(stream);
  DecodedFrame frame;
  for (double time = 0; time < 3 * kSegment - 1; time += 0.5) {
    Status status;
    while ((status = decoder.Interpolate(time, frame)).code() == StatusCode::kNeedMoreData) {
      ASSERT_FALSE(rest.empty());
      ASSERT_TRUE(decoder.Send(rest).ok());
    }
    ASSERT_TRUE(status.ok()) << time << ": " << status.message();
    const auto before = static_cast<std::uint32_t>(time);
    ASSERT_EQ(frame.positions.size(), whole.frames[before].positions.size()) << time;
    if ((before + 1) % kSegment != 0) continue;
    for (std::size_t v = 0; v < frame.positions.size(); ++v) {  // the last frame of a segment stays
      ASSERT_NEAR(frame.positions[v][1], whole.frames[before].positions[v][1], 1e-6) << time;
    }
  }
}

TEST(Segments, CanBeJoinedInTheMiddle) {
  EncoderSettings settings = Grouped();
  settings.repeat_start = 1;
  const Bytes stream = Segmented(settings);
  const Decoded whole = Decode(stream);
  DecoderSettings joining;
  joining.skip_damage = true;
  for (std::size_t begin = 1; begin < stream.size(); begin += stream.size() / 9) {
    Decoder decoder(joining);
    std::vector<DecodedFrame> frames;
    for (auto rest = std::span(stream).subspan(begin); !rest.empty();) {
      ASSERT_TRUE(decoder.Send(rest).ok());
      for (DecodedFrame frame; decoder.Receive(frame).ok();) frames.push_back(frame);
    }
    for (const DecodedFrame& frame : frames) {
      EXPECT_EQ(frame.segment, frame.index / kSegment);
      EXPECT_EQ(frame.positions, whole.frames[frame.index].positions) << begin;
    }
  }
}

TEST(Segments, AGroupWhoseStartIsLostIsNotShownOnAnotherMesh) {
  std::vector<Packet> packets = Packets(Segmented());
  std::size_t headers = 0;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    if (packets[i].type == PacketType::kHeader && ++headers == 2) {
      packets.erase(packets.begin() + static_cast<std::ptrdiff_t>(i),
                    packets.begin() + static_cast<std::ptrdiff_t>(i) + 2);
      break;
    }
  }
  const Bytes stream = Join(packets);
  EXPECT_EQ(Decode(stream).status.code(), StatusCode::kCorrupt);
  DecoderSettings settings;
  settings.skip_damage = true;
  Decoder decoder(settings);
  std::vector<DecodedFrame> frames;
  for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
    ASSERT_TRUE(decoder.Send(rest).ok());
    for (DecodedFrame frame; decoder.Receive(frame).ok();) frames.push_back(frame);
  }
  ASSERT_EQ(frames.size(), 2 * kSegment);
  EXPECT_EQ(frames[kSegment].segment, 2u);
  ASSERT_EQ(decoder.lost_frames().size(), 1u);
  EXPECT_EQ(decoder.lost_frames()[0].first, kSegment);
  EXPECT_EQ(decoder.lost_frames()[0].count, kSegment);
}

TEST(Segments, AStartThatNoGroupFollowsDoesNotCount) {
  const Clip clip = BendingClip(6);
  EncoderSettings other = Grouped();
  other.harmonics = 12;
  const std::vector<Packet> a = Packets(Encode(clip, Grouped()).bytes), b = Packets(Encode(clip, other).bytes);
  ASSERT_EQ(a[2].type, PacketType::kGroup);
  // B without groups, A with its groups, B without groups, then A again before its second group.
  const Bytes stream = Join({b[0], b[1], a[0], a[1], a[2], b[0], b[1], a[0], a[1], a[3], {PacketType::kEnd, {6}}});
  const Decoded got = Decode(stream, 10), whole = Decode(Encode(clip, Grouped()).bytes);
  ASSERT_TRUE(got.status.ok()) << got.status.message();
  ASSERT_EQ(got.frames.size(), 6u);
  for (std::size_t t = 0; t < 6; ++t) EXPECT_EQ(got.frames[t].positions, whole.frames[t].positions);
}

TEST(Segments, AMeshThatCannotBeCodedLeavesTheEncoderAsItWas) {
  const Clip clip = BendingClip(4);
  std::unique_ptr<Encoder> encoder;
  ASSERT_TRUE(Encoder::Create(clip.mesh, Grouped(), encoder).ok());
  ASSERT_TRUE(encoder->Send(clip.frames[0]).ok());
  EXPECT_EQ(encoder->BeginSegment(Mesh{}).code(), StatusCode::kInvalidArgument);
  for (std::size_t i = 1; i < 4; ++i) ASSERT_TRUE(encoder->Send(clip.frames[i]).ok());
  ASSERT_TRUE(encoder->Finish().ok());
  EXPECT_EQ(encoder->TakeBytes(), Encode(clip, Grouped()).bytes);
}

TEST(Segments, TheStillComesBeforeAnythingIsComputed) {
  const Bytes stream = Encode(BendingClip(5), Grouped()).bytes;
  DecoderSettings settings;
  settings.limits.work = 1;  // no basis may be computed
  Decoder decoder(settings);
  std::span<const std::uint8_t> rest(stream);
  EXPECT_EQ(decoder.Prepare().code(), StatusCode::kNeedMoreData);
  while (decoder.mesh() == nullptr) {
    const Status status = decoder.Send(rest);
    ASSERT_TRUE(status.ok()) << status.message();
  }
  EXPECT_EQ(decoder.mesh()->positions.size(), BendingClip(1).mesh.positions.size());
  EXPECT_EQ(decoder.Prepare().code(), StatusCode::kLimit);
  EXPECT_EQ(decoder.Send(rest).code(), StatusCode::kLimit);
}

TEST(Segments, PreparingEarlyChangesNothing) {
  const Bytes stream = Segmented();
  const Decoded whole = Decode(stream);
  Decoder decoder;
  std::vector<DecodedFrame> frames;
  for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
    ASSERT_TRUE(decoder.Send(rest).ok());
    ASSERT_TRUE(decoder.mesh() == nullptr || decoder.Prepare().ok());
    for (DecodedFrame frame; decoder.Receive(frame).ok();) frames.push_back(frame);
  }
  ASSERT_EQ(frames.size(), whole.frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(frames[i].positions, whole.frames[i].positions);
}

}  // namespace
}  // namespace sac

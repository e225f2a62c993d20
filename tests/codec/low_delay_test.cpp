// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "format/bytes.h"
#include "format/packet.h"
#include "tests/test_clips.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

EncoderSettings LowDelay() {
  EncoderSettings settings;
  settings.harmonics = 20;
  settings.group = 5;
  settings.low_delay = true;
  return settings;
}

// The start, what each Send() gives, the end.
std::vector<Bytes> EncodeByFrame(const Clip& clip, const EncoderSettings& settings) {
  std::unique_ptr<Encoder> encoder;
  EXPECT_TRUE(Encoder::Create(clip.mesh, settings, encoder).ok());
  std::vector<Bytes> parts{encoder->TakeBytes()};
  for (const Positions& frame : clip.frames) {
    EXPECT_TRUE(encoder->Send(frame).ok());
    parts.push_back(encoder->TakeBytes());
  }
  EXPECT_TRUE(encoder->Finish().ok());
  parts.push_back(encoder->TakeBytes());
  return parts;
}

TEST(LowDelay, EachFrameIsShownAsSoonAsItIsSent) {
  for (const ReferenceShape reference : {ReferenceShape::kKey, ReferenceShape::kPrevious}) {
    EncoderSettings settings = LowDelay();
    settings.reference_shape = reference;
    const Clip clip = BendingClip(12);
    const std::vector<Bytes> parts = EncodeByFrame(clip, settings);
    const Decoded whole = Decode(Concatenated(parts));
    ASSERT_TRUE(whole.status.ok()) << whole.status.message();
    Decoder decoder;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      DecodedFrame frame;
      std::size_t received = 0;
      for (std::span<const std::uint8_t> rest(parts[i]); !rest.empty();) {
        ASSERT_TRUE(decoder.Send(rest).ok());
        while (decoder.Receive(frame).ok()) ++received;
      }
      const bool is_frame = i > 0 && i <= clip.frames.size();
      ASSERT_EQ(received, is_frame ? 1u : 0u);
      if (!is_frame) continue;
      EXPECT_EQ(frame.index, i - 1);
      EXPECT_EQ(frame.intra, (i - 1) % settings.group == 0);
      EXPECT_EQ(frame.positions, whole.frames[i - 1].positions);
    }
    EXPECT_TRUE(decoder.Finish().ok());
  }
}

// The positions are those of P-frames in whole groups; the bytes hardly more.
TEST(LowDelay, ShowsWhatPFramesShow) {
  for (const ReferenceShape reference : {ReferenceShape::kKey, ReferenceShape::kPrevious}) {
    for (const Clip& clip : {BendingClip(30), TurningPartsClip(30)}) {
      EncoderSettings settings = LowDelay();
      settings.group = 16;
      settings.reference_shape = reference;
      settings.max_error = 0.01;
      const Encoded low_delay = Encode(clip, settings);
      settings.low_delay = false;
      settings.pyramid = 1;
      const Encoded whole = Encode(clip, settings);
      const Decoded a = Decode(low_delay.bytes), b = Decode(whole.bytes);
      ASSERT_EQ(a.frames.size(), 30u) << a.status.message();
      ASSERT_EQ(b.frames.size(), 30u);
      for (std::size_t t = 0; t < 30; ++t) EXPECT_EQ(a.frames[t].positions, b.frames[t].positions) << t;
      // Up to 3 bytes of framing and one for the end of the range code; the groups' own packets are about as long.
      EXPECT_LE(low_delay.bytes.size(), whole.bytes.size() + 4 * 30 + 2 * 8);
    }
  }
}

TEST(LowDelay, FramingIsThreeBytesAtMost) {
  RecordWriter writer;
  EXPECT_EQ(writer.Open(300), WritePacket(PacketType::kGroup, Bytes{0, 0xAC, 0x02, 4}));
  for (const std::size_t size : {0u, 1u, 126u}) EXPECT_EQ(writer.Frame(Bytes(size)).size(), size + 2) << size;
  for (const std::size_t size : {127u, 16382u}) EXPECT_EQ(writer.Frame(Bytes(size)).size(), size + 3) << size;
  EXPECT_EQ(writer.End().size(), 5u);
  // What stands still costs nothing else.
  Clip clip = BendingClip(3);
  clip.frames.resize(10, clip.frames.back());
  EncoderSettings settings = LowDelay();
  settings.group = 128;
  const std::vector<Bytes> parts = EncodeByFrame(clip, settings);
  for (std::size_t i = 5; i <= 10; ++i) EXPECT_LE(parts[i].size(), 3u);
}

TEST(LowDelay, PrefixesGiveAllTheirWholeFrames) {
  const Clip clip = BendingClip(12);
  const std::vector<Bytes> parts = EncodeByFrame(clip, LowDelay());
  const Bytes stream = Concatenated(parts);
  std::size_t whole_bytes = parts[0].size(), frames = 0;
  for (std::size_t size = parts[0].size(); size < stream.size(); ++size) {
    // The last frame of a group is whole before the group's end is.
    const std::size_t end_of_group = frames < 12 && (frames + 1) % 5 == 0 ? 5 : 0;
    if (frames < 12 && size == whole_bytes + parts[frames + 1].size() - end_of_group) {
      whole_bytes += parts[frames + 1].size();
      ++frames;
    }
    const Decoded decoded = Decode(Bytes(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size)));
    EXPECT_EQ(decoded.status.code(), StatusCode::kCorrupt);
    ASSERT_EQ(decoded.frames.size(), frames) << size;
  }
  EXPECT_EQ(frames, 12u);
}

TEST(LowDelay, ChunksMakeNoDifference) {
  const Bytes stream = Encode(BendingClip(7), LowDelay()).bytes;
  const Decoded whole = Decode(stream);
  ASSERT_EQ(whole.frames.size(), 7u);
  for (const std::size_t chunk : {1u, 2u, 3u, 7u, 100u}) {
    const Decoded decoded = Decode(stream, chunk);
    ASSERT_TRUE(decoded.status.ok());
    ASSERT_EQ(decoded.frames.size(), 7u);
    for (std::size_t t = 0; t < 7; ++t) EXPECT_EQ(decoded.frames[t].positions, whole.frames[t].positions);
  }
}

TEST(LowDelay, DecodingBeginsAtAnyGroup) {
  const Clip clip = BendingClip(12);
  const Bytes stream = Encode(clip, LowDelay()).bytes;
  const Decoded whole = Decode(stream);
  std::vector<Packet> packets = Packets(stream);
  ASSERT_EQ(Join(packets), stream);
  packets.erase(packets.begin() + 2, packets.begin() + 9);  // the first group: its packet, 5 frames, its end
  DecoderSettings settings;
  settings.skip_damage = true;
  const Decoded decoded = Decode(Join(packets), stream.size(), settings);
  ASSERT_TRUE(decoded.status.ok()) << decoded.status.message();
  ASSERT_EQ(decoded.frames.size(), 7u);
  for (std::size_t t = 0; t < 7; ++t) EXPECT_EQ(decoded.frames[t].positions, whole.frames[t + 5].positions);
}

TEST(LowDelay, EveryChangedBitIsNoticed) {
  const Bytes stream = Encode(BendingClip(6), LowDelay()).bytes;
  for (std::size_t bit = 0; bit < 8 * stream.size(); ++bit) {
    Bytes changed = stream;
    changed[bit / 8] ^= static_cast<std::uint8_t>(1 << (bit % 8));
    EXPECT_FALSE(Decode(changed).status.ok()) << bit;
  }
}

TEST(LowDelay, MutatedFramesAreHarmless) {
  std::mt19937 random(11);
  EncoderSettings settings = LowDelay();
  settings.max_error = 0.02;
  const std::vector<Packet> packets = Packets(Encode(BendingClip(6), settings).bytes);
  int accepted = 0, refused = 0;
  for (int i = 0; i < 1500; ++i) {
    std::vector<Packet> changed = packets;
    Packet& packet = changed[2 + random() % (changed.size() - 3)];
    if (packet.type != PacketType::kFrame) continue;
    if (packet.payload.empty() || random() % 4 == 0) packet.payload.push_back(static_cast<std::uint8_t>(random()));
    packet.payload[random() % packet.payload.size()] = static_cast<std::uint8_t>(random());
    const Decoded decoded = Decode(Join(changed));
    EXPECT_TRUE(decoded.status.ok() || decoded.status.code() == StatusCode::kCorrupt) << decoded.status.message();
    ++(decoded.status.ok() ? accepted : refused);
  }
  EXPECT_GT(accepted, 0);
  EXPECT_GT(refused, 0);
}

TEST(LowDelay, LimitsAreRespected) {
  const Bytes stream = Encode(BendingClip(6), LowDelay()).bytes;  // groups of 5
  DecoderSettings settings;
  settings.limits.expert.frames_per_group = 5;
  EXPECT_TRUE(Decode(stream, stream.size(), settings).status.ok());
  settings.limits.expert.frames_per_group = 4;
  const Decoded few = Decode(stream, stream.size(), settings);
  EXPECT_EQ(few.status.code(), StatusCode::kLimit);
  EXPECT_EQ(few.frames.size(), 4u);
}

TEST(LowDelay, AnEmptyGroupIsNothing) {
  std::vector<Packet> packets = Packets(Encode(BendingClip(2), LowDelay()).bytes);
  packets.insert(packets.begin() + 2, {PacketType::kGroupEnd, {}});
  packets.insert(packets.begin() + 2, {PacketType::kGroup, {0, 0, 4}});
  const Decoded decoded = Decode(Join(packets));
  EXPECT_TRUE(decoded.status.ok()) << decoded.status.message();
  EXPECT_EQ(decoded.frames.size(), 2u);
}

// After a frame that cannot be coded the group could not go on.
TEST(LowDelay, AFrameThatCannotBeCodedEndsTheStream) {
  Clip clip = BendingClip(3);
  EncoderSettings settings = LowDelay();
  settings.max_error = 1e-5;
  std::unique_ptr<Encoder> encoder;
  ASSERT_TRUE(Encoder::Create(clip.mesh, settings, encoder).ok());
  ASSERT_TRUE(encoder->Send(clip.frames[0]).ok());
  std::mt19937 random(1);
  for (Vec3f& p : clip.frames[1]) p[0] += static_cast<float>(1e5 * Signed(random));
  const Status failed = encoder->Send(clip.frames[1]);
  EXPECT_EQ(failed.code(), StatusCode::kInvalidArgument);
  ASSERT_TRUE(encoder->fault() && encoder->fault()->vertex);
  EXPECT_EQ(encoder->fault()->frame, 1u);
  const std::string where = "frame 1, vertex " + std::to_string(*encoder->fault()->vertex) + ": ";
  EXPECT_EQ(failed.message().rfind(where, 0), 0u) << failed.message();
  EXPECT_EQ(encoder->Send(clip.frames[2]).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(encoder->frames(), 1u);
  // What was coded before is a stream.
  ASSERT_TRUE(encoder->Finish().ok());
  const Decoded decoded = Decode(encoder->TakeBytes());
  EXPECT_TRUE(decoded.status.ok()) << decoded.status.message();
  EXPECT_EQ(decoded.frames.size(), 1u);
}

}  // namespace
}  // namespace sac

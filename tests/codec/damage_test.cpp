// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "tests/test_clips.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

constexpr std::uint32_t kFrames = 20, kGroup = 5;

EncoderSettings Grouped() {
  EncoderSettings settings;
  settings.harmonics = 20;
  settings.group = kGroup;
  settings.pyramid = 2;
  return settings;
}

struct Survived {
  Status status;
  std::vector<DecodedFrame> frames;
  std::vector<FrameRange> lost;
};

Survived DecodeDamaged(const Bytes& stream, std::size_t chunk) {
  DecoderSettings settings;
  settings.skip_damage = true;
  Decoder decoder(settings);
  Survived out;
  const auto receive = [&] {
    for (DecodedFrame frame; (out.status = decoder.Receive(frame)).ok();) out.frames.push_back(frame);
  };
  for (std::size_t at = 0; at < stream.size(); at += chunk) {
    const auto part = std::span(stream).subspan(at, std::min(chunk, stream.size() - at));
    const Bytes buffer(part.begin(), part.end());
    for (std::span<const std::uint8_t> rest(buffer); !rest.empty(); receive()) {
      out.status = decoder.Send(rest);
      EXPECT_TRUE(out.status.ok()) << out.status.message();
      if (!out.status.ok()) return out;
    }
  }
  out.status = decoder.Finish();
  const Status end = out.status;
  receive();
  out.status = end;
  out.lost = decoder.lost_frames();
  return out;
}

// What was given out is right, and what is missing is known to be.
void ExpectWithout(const Survived& got, const Decoded& whole, std::uint32_t first, std::uint32_t end) {
  ASSERT_TRUE(got.status.ok()) << got.status.message();
  ASSERT_EQ(got.frames.size(), whole.frames.size() - (end - first));
  for (const DecodedFrame& frame : got.frames) {
    EXPECT_TRUE(frame.index < first || frame.index >= end);
    EXPECT_EQ(frame.positions, whole.frames[frame.index].positions);
  }
  if (first == end) {
    EXPECT_TRUE(got.lost.empty());
    return;
  }
  ASSERT_EQ(got.lost.size(), 1u);
  EXPECT_EQ(got.lost[0].first, first);
  EXPECT_EQ(got.lost[0].count, end - first);
}

TEST(Damage, BuffersAreCheckedWhenTheMeshIsReadAgain) {
  // A packet that swallows the start and the first group: they come out of it when its check turns out wrong.
  const std::vector<Packet> packets = Packets(Encode(BendingClip(kFrames), Grouped()).bytes);
  Bytes hidden;
  for (std::size_t i = 0; i < 3; ++i) {
    const Bytes packet = WritePacket(packets[i].type, packets[i].payload);
    hidden.insert(hidden.end(), packet.begin(), packet.end());
  }
  Bytes stream = Concatenated({Join({}), WritePacket(PacketType::kGroup, hidden)});
  stream.back() ^= 1;
  DecoderSettings settings;
  settings.skip_damage = true;
  Decoder decoder(settings);
  for (std::span<const std::uint8_t> rest(stream); !rest.empty();) ASSERT_TRUE(decoder.Send(rest).ok());
  ASSERT_EQ(decoder.mesh(), nullptr);
  std::vector<float> memory(3);
  FrameBuffers buffers;
  buffers.positions = {memory.data(), 12, 12, VertexFormat::kFloat32};
  FrameInfo info;
  EXPECT_EQ(decoder.Receive(buffers, info).code(), StatusCode::kInvalidArgument);
  ASSERT_NE(decoder.mesh(), nullptr);
  memory.resize(3 * decoder.mesh()->positions.size());
  buffers.positions = {memory.data(), 4 * memory.size(), 12, VertexFormat::kFloat32};
  EXPECT_TRUE(decoder.Receive(buffers, info).ok());  // it still waited
  EXPECT_EQ(info.index, 0u);
}

// The bytes of each group, with those of its records.
std::vector<std::pair<std::size_t, std::size_t>> GroupBytes(const Bytes& stream) {
  std::vector<std::pair<std::size_t, std::size_t>> groups;
  PacketReader reader{Limits{}};
  std::optional<Packet> packet;
  std::size_t begin = 4;
  for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
    EXPECT_TRUE(reader.Read(rest, packet).ok());
    if (!packet) continue;
    if (packet->type == PacketType::kGroup) groups.push_back({begin, reader.position()});
    if (packet->type == PacketType::kFrame || packet->type == PacketType::kGroupEnd) {
      groups.back().second = reader.position();
    }
    begin = reader.position();
  }
  return groups;
}

TEST(Damage, APacketCostsItsGroup) {
  const Bytes stream = Encode(BendingClip(kFrames), Grouped()).bytes;
  const Decoded whole = Decode(stream);
  const auto groups = GroupBytes(stream);
  ASSERT_EQ(groups.size(), kFrames / kGroup);
  ExpectWithout(DecodeDamaged(stream, stream.size()), whole, 0, 0);
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    for (std::size_t byte = groups[g].first; byte < groups[g].second; ++byte) {
      const std::size_t offset = byte - groups[g].first;
      Bytes damaged = stream;
      damaged[byte] ^= static_cast<std::uint8_t>(offset % 4 == 0 ? 0xff : 1 << (offset % 8));
      ExpectWithout(DecodeDamaged(damaged, byte % 3 == 0 ? 7 : damaged.size()), whole, g * kGroup, (g + 1) * kGroup);
      if (HasFatalFailure()) FAIL() << "group " << g << " byte " << offset;
    }
  }
}

TEST(Damage, OfAnOpenGroupTheFramesBeforeStay) {
  EncoderSettings settings = Grouped();
  settings.low_delay = true;
  const Bytes stream = Encode(BendingClip(kFrames), settings).bytes;
  const Decoded whole = Decode(stream);
  const auto groups = GroupBytes(stream);
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    std::size_t most = 0;
    for (std::size_t byte = groups[g].first; byte < groups[g].second; ++byte) {
      Bytes damaged = stream;
      damaged[byte] ^= 0x40;
      const Survived got = DecodeDamaged(damaged, damaged.size());
      ASSERT_TRUE(got.status.ok()) << byte;
      const std::size_t missing = kFrames - got.frames.size();
      EXPECT_LE(missing, kGroup);
      most = std::max(most, missing);
      for (const DecodedFrame& frame : got.frames) EXPECT_EQ(frame.positions, whole.frames[frame.index].positions);
      if (missing == 0) continue;  // the end of the group
      ASSERT_EQ(got.lost.size(), 1u);
      EXPECT_EQ(got.lost[0].count, missing);
      EXPECT_EQ(got.lost[0].first + got.lost[0].count, (g + 1) * kGroup);
    }
    EXPECT_EQ(most, kGroup);
  }
}

TEST(Damage, AStreamCanBeEnteredAnywhere) {
  EncoderSettings settings = Grouped();
  settings.repeat_start = 1;
  const Bytes stream = Encode(BendingClip(kFrames), settings).bytes;
  const Decoded whole = Decode(stream);
  const auto groups = GroupBytes(stream);
  // The start is there again before each group but the first.
  const std::size_t start = groups[0].first - 4;
  for (std::size_t from = 1; from < stream.size(); from += 5) {
    std::uint32_t first = 0;
    while (first < groups.size() && (first == 0 ? 4 : groups[first].first - start) < from) ++first;
    const Bytes rest(stream.begin() + static_cast<std::ptrdiff_t>(from), stream.end());
    const Survived got = DecodeDamaged(rest, 11);
    if (first == groups.size()) {
      EXPECT_FALSE(got.status.ok());
      EXPECT_TRUE(got.frames.empty());
    } else {
      ExpectWithout(got, whole, 0, first * kGroup);
    }
  }
}

TEST(Damage, ADamagedStartWaitsForTheNext) {
  EncoderSettings settings = Grouped();
  settings.repeat_start = 2;
  const Bytes stream = Encode(BendingClip(kFrames), settings).bytes;
  const Decoded whole = Decode(stream);
  const std::size_t first_group = GroupBytes(stream)[0].first;
  for (std::size_t byte = 0; byte < first_group; ++byte) {
    Bytes damaged = stream;
    damaged[byte] ^= 0x21;
    const Survived got = DecodeDamaged(damaged, damaged.size());
    // Without its magic the rest is sound; what precedes the second start is lost otherwise.
    ExpectWithout(got, whole, 0, byte < 4 ? 0 : 2 * kGroup);
    if (HasFatalFailure()) FAIL() << byte;
  }
}

TEST(Damage, ACutStreamGivesAllWholeFrames) {
  EncoderSettings settings = Grouped();
  settings.group = kFrames;
  settings.index = false;
  const Bytes stream = Encode(BendingClip(kFrames), settings).bytes;
  const Decoded whole = Decode(stream);
  const auto group = GroupBytes(stream).at(0);
  std::size_t before = 0;
  for (std::size_t size = group.first; size < group.second; ++size) {
    const Survived got = DecodeDamaged({stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size)}, 100);
    EXPECT_GE(got.frames.size(), before) << size;
    before = got.frames.size();
    for (const DecodedFrame& frame : got.frames)
      EXPECT_EQ(frame.positions, whole.frames[frame.index].positions) << size;
  }
  EXPECT_GE(before, kFrames - 4);
}

TEST(Damage, TheGroupThatIsSoughtMayBeDamaged) {
  const Bytes stream = Encode(BendingClip(kFrames), Grouped()).bytes;
  const auto groups = GroupBytes(stream);
  DecoderSettings settings;
  settings.skip_damage = true;
  Decoder decoder(settings);
  const auto read = [&](const Bytes& from, std::uint64_t byte) {
    std::vector<std::uint32_t> given;
    for (auto rest = std::span(from).subspan(byte); !rest.empty();) {
      EXPECT_TRUE(decoder.Send(rest).ok());
      for (DecodedFrame frame; decoder.Receive(frame).ok();) given.push_back(frame.index);
    }
    return given;
  };
  EXPECT_EQ(read(stream, 0).size(), kFrames);
  Bytes damaged = stream;
  damaged[groups[1].second - 6] ^= 1;
  std::uint64_t byte = 0;
  ASSERT_TRUE(decoder.Seek(kGroup + 2, byte).ok());
  EXPECT_EQ(byte, groups[1].first);
  const std::vector<std::uint32_t> given = read(damaged, byte);
  ASSERT_EQ(given.size(), kFrames - 2 * kGroup);
  EXPECT_EQ(given[0], 2 * kGroup);
  ASSERT_EQ(decoder.lost_frames().size(), 1u);
  EXPECT_EQ(decoder.lost_frames()[0].first, kGroup);
  EXPECT_EQ(decoder.lost_frames()[0].count, kGroup);
}

TEST(Damage, AnotherStreamIsNotShownOnThisMesh) {
  const Bytes one = Encode(BendingClip(kGroup), Grouped()).bytes;
  EncoderSettings settings = Grouped();
  settings.harmonics = 12;
  const Bytes other = Encode(BendingClip(3 * kGroup), settings).bytes;
  const std::vector<Packet> first = Packets(one), second = Packets(other);
  std::vector<Packet> joined(first.begin(), first.end() - 1);  // without its end
  joined.insert(joined.end(), second.begin(), second.end());
  const Survived got = DecodeDamaged(Join(joined), 100);
  EXPECT_EQ(got.frames.size(), kGroup);
  ASSERT_EQ(got.lost.size(), 1u);
  EXPECT_EQ(got.lost[0].first, kGroup);
}

TEST(Damage, AnotherStreamTakesTheMeshThatIsMissing) {
  const Bytes one = Encode(BendingClip(kGroup), Grouped()).bytes;
  EncoderSettings settings = Grouped();
  settings.harmonics = 12;
  const Bytes other = Encode(BendingClip(3 * kGroup), settings).bytes;
  std::vector<Packet> packets = Packets(one);
  packets.erase(packets.begin() + 1);  // the I-frame
  for (const Packet& p : Packets(other)) packets.push_back(p);
  const Survived got = DecodeDamaged(Join(packets), 100);
  ASSERT_EQ(got.frames.size(), 3 * kGroup);
  EXPECT_EQ(got.frames.back().positions, Decode(other).frames.back().positions);
}

TEST(Damage, TheFirstGroupMayBeSoughtAndLost) {
  Bytes stream = Encode(BendingClip(kFrames), Grouped()).bytes;
  const auto groups = GroupBytes(stream);
  stream[groups[0].second - 6] ^= 1;
  DecoderSettings settings;
  settings.skip_damage = true;
  Decoder decoder(settings);
  std::span<const std::uint8_t> rest(stream);
  while (!decoder.mesh()) ASSERT_TRUE(decoder.Send(rest).ok());
  std::uint64_t byte = 0;
  ASSERT_TRUE(decoder.Seek(0, byte).ok());
  EXPECT_EQ(byte, groups[0].first);
  for (rest = std::span(stream).subspan(byte); !rest.empty();) {
    ASSERT_TRUE(decoder.Send(rest).ok());
    for (DecodedFrame frame; decoder.Receive(frame).ok();) EXPECT_GE(frame.index, kGroup);
  }
  ASSERT_EQ(decoder.lost_frames().size(), 1u);
  EXPECT_EQ(decoder.lost_frames()[0].first, 0u);
  EXPECT_EQ(decoder.lost_frames()[0].count, kGroup);
}

TEST(Damage, ACutGroupIsSentAgainAfterASeek) {
  const Bytes stream = Encode(BendingClip(kFrames), Grouped()).bytes;
  const Decoded whole = Decode(stream);
  const auto groups = GroupBytes(stream);
  DecoderSettings settings;
  settings.skip_damage = true;
  Decoder decoder(settings);
  DecodedFrame frame;
  for (auto rest = std::span(stream).first((groups[1].first + 2 * groups[1].second) / 3); !rest.empty();) {
    ASSERT_TRUE(decoder.Send(rest).ok());
    while (decoder.Receive(frame).ok()) {
    }
  }
  (void)decoder.Finish();
  while (decoder.Receive(frame).ok()) {
  }
  std::uint64_t byte = 0;
  ASSERT_TRUE(decoder.Seek(kGroup + 3, byte).ok());
  auto rest = std::span(stream).subspan(byte);
  Status status;
  while ((status = decoder.Interpolate(kGroup + 3, frame)).code() == StatusCode::kNeedMoreData && !rest.empty()) {
    ASSERT_TRUE(decoder.Send(rest).ok());
  }
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(frame.positions, whole.frames[kGroup + 3].positions);
}

// A cut group without its check may say anything.
TEST(Damage, ACutGroupHasToFit) {
  EncoderSettings settings = Grouped();
  settings.index = false;
  Bytes stream = Encode(BendingClip(kFrames), settings).bytes;
  stream.resize(GroupBytes(stream)[0].second);
  const Bytes group = WritePacket(PacketType::kGroup, WriteGroup({4000, 3000000000u, 8}, Bytes(300, 0x55)));
  stream.insert(stream.end(), group.begin(), group.end() - 100);
  const Survived got = DecodeDamaged(stream, 100);
  EXPECT_EQ(got.frames.size(), kGroup);
  EXPECT_TRUE(got.lost.empty());
}

TEST(Damage, LimitsAreNone) {
  const Bytes stream = Encode(BendingClip(kFrames), Grouped()).bytes;
  DecoderSettings settings;
  settings.skip_damage = true;
  settings.limits.expert.frames_per_group = kGroup - 1;
  EXPECT_EQ(Decode(stream, stream.size(), settings).status.code(), StatusCode::kLimit);
}

TEST(Damage, TheEndIsToldInTheEnd) {
  EncoderSettings settings = Grouped();
  settings.index = false;
  Bytes stream = Encode(BendingClip(kFrames), settings).bytes;
  stream.resize(GroupBytes(stream).back().second - 10);
  EXPECT_EQ(DecodeDamaged(stream, stream.size()).status.code(), StatusCode::kCorrupt);
}

TEST(Damage, ManyWoundsAreHarmless) {
  EncoderSettings settings = Grouped();
  settings.repeat_start = 3;
  std::vector<Bytes> streams = {Encode(BendingClip(kFrames), settings).bytes};
  settings.low_delay = true;
  streams.push_back(Encode(BendingClip(kFrames), settings).bytes);
  std::mt19937 random(3);
  for (int i = 0; i < 400; ++i) {
    Bytes damaged = streams[i % 2];
    for (int wounds = 1 + static_cast<int>(random() % 8); wounds > 0; --wounds) {
      const auto at = damaged.begin() + static_cast<std::ptrdiff_t>(random() % damaged.size());
      switch (random() % 3) {
        case 0:
          *at = static_cast<std::uint8_t>(random());
          break;
        case 1:
          damaged.erase(at, std::min(damaged.end(), at + static_cast<std::ptrdiff_t>(random() % 40)));
          break;
        default:
          damaged.insert(at, random() % 20, static_cast<std::uint8_t>(random()));
      }
    }
    const Survived whole = DecodeDamaged(damaged, damaged.size()), bytes = DecodeDamaged(damaged, 3);
    EXPECT_EQ(whole.frames.size(), bytes.frames.size());
    EXPECT_EQ(whole.status.code(), bytes.status.code());
    std::uint64_t lost = 0;
    for (const FrameRange& range : whole.lost) lost += range.count;
    EXPECT_LE(whole.frames.size() + lost, kFrames);
  }
}

}  // namespace
}  // namespace sac

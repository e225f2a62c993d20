// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <optional>

#include "format/bytes.h"
#include "format/packet.h"
#include "tests/test_clips.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

// Small streams that between them use every part of the format.
std::vector<Bytes> Streams() {
  EncoderSettings plain;
  plain.group = 3;
  plain.harmonics = 20;
  EncoderSettings previous = plain;
  previous.reference_shape = ReferenceShape::kPrevious;
  previous.pyramid = 1;
  previous.handles_per_harmonic = 0;
  EncoderSettings ordered = plain;
  ordered.keep_order = true;
  ordered.group = 16;
  EncoderSettings fine = plain;
  fine.detail_step = 0.002;
  fine.max_error = 0.01;
  Clip bending{TubeMesh(4, 5), {}};
  for (int t = 0; t < 7; ++t) bending.frames.push_back(BentTube(bending.mesh, 0.2 * t));
  Clip parts;  // with attributes and whatever Draco does not take
  parts.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1},
                          {2, 2, 2}, {3, 2, 2}, {2, 3, 2}, {9, 9, 9}};
  parts.mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {5, 6, 7}, {6, 6, 7}, {2, 1, 0}};
  parts.mesh.uvs = {{0, 0}, {1, 0}, {0.5f, 1}};
  parts.mesh.uv_triangles.assign(6, {0, 1, 2});
  parts.mesh.normals.assign(9, {0, 0, 1});
  parts.mesh.colors.assign(9, {1, 2, 3, 4});
  for (int t = 0; t < 5; ++t) {
    parts.frames.push_back(Moved(parts.mesh.positions, AxisAngle({1, 1, 0}, 0.3 * t), {0.1 * t, 0, 0}));
  }
  return {Encode(bending, plain).bytes, Encode(bending, previous).bytes, Encode(parts, ordered).bytes,
          Encode(bending, fine).bytes};
}

// What a mutated stream may spend.
DecoderSettings Small() {
  DecoderSettings settings;
  settings.limits.vertices = 200;
  settings.limits.expert.triangles = 400;
  settings.limits.expert.harmonics = 100;
  settings.limits.expert.frames_per_group = 64;
  settings.limits.expert.packet_bytes = 1 << 16;
  settings.limits.expert.basis_values = 20000;
  return settings;
}

// Decodes what may be malformed: either well or with an error and its message; what it gives agrees with itself.
Decoded DecodeAnything(const Bytes& stream) {
  const Decoded decoded = Decode(stream, stream.size() + 1, Small());
  EXPECT_EQ(decoded.status.ok(), decoded.status.message().empty());
  EXPECT_TRUE(decoded.status.code() == StatusCode::kOk || decoded.status.code() == StatusCode::kCorrupt ||
              decoded.status.code() == StatusCode::kUnsupported || decoded.status.code() == StatusCode::kLimit)
      << decoded.status.message();
  EXPECT_LE(decoded.mesh.positions.size(), 200u);
  EXPECT_LE(decoded.mesh.triangles.size(), 400u);
  for (const Triangle& t : decoded.mesh.triangles) {
    EXPECT_LT(*std::max_element(t.begin(), t.end()), decoded.mesh.positions.size());
  }
  for (const Triangle& t : decoded.mesh.uv_triangles) {
    EXPECT_LT(*std::max_element(t.begin(), t.end()), decoded.mesh.uvs.size());
  }
  for (const DecodedFrame& frame : decoded.frames) {
    EXPECT_EQ(frame.positions.size(), decoded.mesh.positions.size());
  }
  return decoded;
}

TEST(Robustness, PrefixesGiveTheFramesOfTheirWholePackets) {
  for (const Bytes& stream : Streams()) {
    const Decoded whole = DecodeAnything(stream);
    ASSERT_TRUE(whole.status.ok());
    // Frames that are there once so many bytes are.
    std::vector<std::size_t> frames(stream.size() + 1, 0);
    std::size_t end = 4, count = 0;
    for (const Packet& p : Packets(stream)) {
      end += WritePacket(p.type, p.payload).size();
      if (p.type == PacketType::kGroup) count += ByteReader(p.payload).Varint();
      frames[end] = count;
    }
    for (std::size_t size = 1; size < frames.size(); ++size) frames[size] = std::max(frames[size], frames[size - 1]);
    EXPECT_EQ(frames.back(), whole.frames.size());
    for (std::size_t size = 0; size < stream.size(); ++size) {
      const Bytes prefix(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size));
      const Decoded decoded = DecodeAnything(prefix);
      EXPECT_EQ(decoded.status.code(), StatusCode::kCorrupt) << size;
      ASSERT_EQ(decoded.frames.size(), frames[size]) << size;
      for (std::size_t t = 0; t < frames[size]; ++t) EXPECT_EQ(decoded.frames[t].positions, whole.frames[t].positions);
    }
  }
}

TEST(Robustness, AByteMoreIsRefused) {
  for (Bytes stream : Streams()) {
    const std::size_t frames = DecodeAnything(stream).frames.size();
    for (const std::uint8_t more : {0x00, 0x53, 0xff}) {
      stream.push_back(more);
      const Decoded decoded = DecodeAnything(stream);
      EXPECT_EQ(decoded.status.code(), StatusCode::kCorrupt);
      EXPECT_EQ(decoded.frames.size(), frames);
      stream.pop_back();
    }
  }
}

TEST(Robustness, AnErrorIsFinal) {
  Bytes stream = Streams()[0];
  const Bytes good = stream;
  stream[stream.size() / 2] ^= 1;
  Decoder decoder;
  DecodedFrame frame;
  Status status;
  for (std::span<const std::uint8_t> rest(stream); status.ok() && !rest.empty();) {
    status = decoder.Send(rest);
    while (decoder.Receive(frame).ok()) {
    }
  }
  EXPECT_EQ(status.code(), StatusCode::kCorrupt);
  std::span<const std::uint8_t> again(good);
  EXPECT_EQ(decoder.Send(again).code(), StatusCode::kCorrupt);
  EXPECT_EQ(decoder.Receive(frame).code(), StatusCode::kCorrupt);
  EXPECT_EQ(decoder.Finish().code(), StatusCode::kCorrupt);
}

TEST(Robustness, PacketsOutOfPlaceAreRefused) {
  const std::vector<Packet> packets = Packets(Streams()[0]);
  for (std::size_t i = 0; i < packets.size(); ++i) {
    std::vector<Packet> missing = packets, doubled = packets;
    missing.erase(missing.begin() + static_cast<std::ptrdiff_t>(i));
    doubled.insert(doubled.begin() + static_cast<std::ptrdiff_t>(i), packets[i]);
    EXPECT_EQ(DecodeAnything(Join(missing)).status.code(), StatusCode::kCorrupt) << i;
    EXPECT_EQ(DecodeAnything(Join(doubled)).status.code(), StatusCode::kCorrupt) << i;
    if (i + 1 == packets.size()) continue;
    std::vector<Packet> swapped = packets;
    std::swap(swapped[i], swapped[i + 1]);
    EXPECT_EQ(DecodeAnything(Join(swapped)).status.code(), StatusCode::kCorrupt) << i;
  }
}

TEST(Robustness, EveryChangedBitIsNoticed) {
  const Bytes stream = Streams()[2];
  for (std::size_t bit = 0; bit < 8 * stream.size(); bit += 3) {
    Bytes changed = stream;
    changed[bit / 8] ^= static_cast<std::uint8_t>(1 << (bit % 8));
    EXPECT_FALSE(DecodeAnything(changed).status.ok()) << bit;
  }
}

// Changes bytes of one packet, adds or takes some, and puts the checksum right.
Bytes Mutated(std::vector<Packet> packets, std::size_t which, std::mt19937& random) {
  Bytes& payload = packets[which].payload;
  for (std::size_t i = 1 + random() % 3; i > 0; --i) {
    const std::size_t at = payload.empty() ? 0 : random() % payload.size();
    const auto position = payload.begin() + static_cast<std::ptrdiff_t>(at);
    switch (payload.empty() ? 5 : random() % 6) {
      case 0:
      case 1:
        payload[at] ^= static_cast<std::uint8_t>(1 << (random() % 8));
        break;
      case 2:
        payload[at] = static_cast<std::uint8_t>(random());
        break;
      case 3:
        payload[at] = random() % 2 ? 0 : 0xff;
        break;
      case 4:
        payload.erase(position);
        break;
      default:
        payload.insert(position, static_cast<std::uint8_t>(random()));
    }
  }
  return Join(packets);
}

void MutatePackets(PacketType type, int rounds) {
  std::mt19937 random(static_cast<std::uint32_t>(type) + 1);
  int accepted = 0, refused = 0;
  for (const Bytes& stream : Streams()) {
    const std::vector<Packet> packets = Packets(stream);
    std::vector<std::size_t> candidates;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      if (packets[i].type == type) candidates.push_back(i);
    }
    for (int i = 0; i < rounds; ++i) {
      const Bytes changed = Mutated(packets, candidates[random() % candidates.size()], random);
      ++(DecodeAnything(changed).status.ok() ? accepted : refused);
    }
  }
  EXPECT_GT(refused, 0);
  if (type == PacketType::kGroup) {
    EXPECT_GT(accepted, 0);  // other coefficients are as good
  }
}

TEST(Robustness, MutatedHeadersAreHarmless) { MutatePackets(PacketType::kHeader, 400); }
TEST(Robustness, MutatedIFramesAreHarmless) { MutatePackets(PacketType::kIFrame, 400); }
TEST(Robustness, MutatedGroupsAreHarmless) { MutatePackets(PacketType::kGroup, 700); }
TEST(Robustness, MutatedEndsAreHarmless) { MutatePackets(PacketType::kEnd, 100); }

TEST(Robustness, RandomPayloadsAreHarmless) {
  std::mt19937 random(7);
  std::vector<Packet> packets = Packets(Streams()[0]);
  const std::vector<Packet> original = packets;
  int accepted = 0;
  for (int i = 0; i < 1500; ++i) {
    packets = original;
    const std::size_t which = random() % packets.size();
    packets[which].payload.resize(random() % 80);
    for (auto& b : packets[which].payload) b = static_cast<std::uint8_t>(random());
    accepted += DecodeAnything(Join(packets)).status.ok();
  }
  EXPECT_LT(accepted, 15);  // a group of one frame may be anything
}

TEST(Robustness, LimitsAreRespected) {
  const Bytes stream = Streams()[0];  // 20 vertices, 30 triangles, 20 harmonics, groups of 3
  std::size_t longest = 0;
  for (const Packet& p : Packets(stream)) longest = std::max(longest, p.payload.size());
  const auto decode = [&](const DecoderSettings& settings) {
    return Decode(stream, stream.size(), settings).status.code();
  };
  const auto with = [&](auto Limits::*limit, auto value) {
    DecoderSettings settings;
    settings.limits.*limit = value;
    return decode(settings);
  };
  const auto with_expert = [&](auto ExpertLimits::*limit, auto value) {
    DecoderSettings settings;
    settings.limits.expert.*limit = value;
    return decode(settings);
  };
  EXPECT_EQ(with(&Limits::vertices, 20u), StatusCode::kOk);
  EXPECT_EQ(with(&Limits::vertices, 19u), StatusCode::kLimit);
  EXPECT_EQ(with_expert(&ExpertLimits::triangles, 30u), StatusCode::kOk);
  EXPECT_EQ(with_expert(&ExpertLimits::triangles, 29u), StatusCode::kLimit);
  EXPECT_EQ(with_expert(&ExpertLimits::harmonics, 20u), StatusCode::kOk);
  EXPECT_EQ(with_expert(&ExpertLimits::harmonics, 19u), StatusCode::kLimit);
  EXPECT_EQ(with_expert(&ExpertLimits::basis_values, std::uint64_t{400}), StatusCode::kOk);
  EXPECT_EQ(with_expert(&ExpertLimits::basis_values, std::uint64_t{399}), StatusCode::kLimit);
  EXPECT_EQ(with_expert(&ExpertLimits::factor_values, std::uint64_t{400}), StatusCode::kOk);
  EXPECT_EQ(with_expert(&ExpertLimits::factor_values, std::uint64_t{40}), StatusCode::kLimit);
  EXPECT_EQ(with(&Limits::memory, std::uint64_t{100000}), StatusCode::kOk);
  EXPECT_EQ(with(&Limits::memory, std::uint64_t{20000}), StatusCode::kLimit);
  EXPECT_EQ(with(&Limits::work, 1e6), StatusCode::kOk);
  EXPECT_EQ(with(&Limits::work, 1e4), StatusCode::kLimit);
  EXPECT_EQ(with_expert(&ExpertLimits::frame_work, 1e5), StatusCode::kOk);
  EXPECT_EQ(with_expert(&ExpertLimits::frame_work, 1e3), StatusCode::kLimit);
  EXPECT_EQ(with_expert(&ExpertLimits::frames_per_group, 3u), StatusCode::kOk);
  EXPECT_EQ(with_expert(&ExpertLimits::frames_per_group, 2u), StatusCode::kLimit);
  EXPECT_EQ(with_expert(&ExpertLimits::packet_bytes, static_cast<std::uint32_t>(longest)), StatusCode::kOk);
  EXPECT_EQ(with_expert(&ExpertLimits::packet_bytes, static_cast<std::uint32_t>(longest - 1)), StatusCode::kLimit);
}

TEST(Robustness, WorkIsBoundedByBytes) {
  const Bytes stream = Streams()[0];
  const auto with = [&](double free, double per_byte) {
    DecoderSettings settings;
    settings.limits.expert.free_work = free;
    settings.limits.expert.work_per_byte = per_byte;
    return Decode(stream, stream.size(), settings).status.code();
  };
  EXPECT_EQ(with(1e6, 0), StatusCode::kOk);
  EXPECT_EQ(with(1e3, 0), StatusCode::kLimit);
  EXPECT_EQ(with(1e3, 1e4), StatusCode::kOk);
}

}  // namespace
}  // namespace sac

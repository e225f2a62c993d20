// SPDX-License-Identifier: Apache-2.0
#include "format/packet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes Magic() { return {std::begin(kMagic), std::end(kMagic)}; }

void Append(Bytes& stream, const Bytes& more) { stream.insert(stream.end(), more.begin(), more.end()); }

Bytes Payload(std::size_t size, std::uint32_t seed) {
  std::mt19937 random(seed);
  Bytes bytes(size);
  for (auto& b : bytes) b = static_cast<std::uint8_t>(random());
  return bytes;
}

struct Outcome {
  Status status;
  std::vector<Packet> packets;
  bool at_boundary = false;
  std::uint64_t position = 0;
};

// Reads `stream` in chunks, each in a buffer of its own size.
Outcome Read(const Bytes& stream, std::size_t chunk, const Limits& limits = {}) {
  PacketReader reader(limits);
  Outcome outcome;
  for (std::size_t at = 0; at < stream.size() && outcome.status.ok(); at += chunk) {
    const auto begin = stream.begin() + static_cast<std::ptrdiff_t>(at);
    const Bytes buffer(begin, begin + static_cast<std::ptrdiff_t>(std::min(chunk, stream.size() - at)));
    for (std::span<const std::uint8_t> rest(buffer); !rest.empty();) {
      const std::size_t before = rest.size();
      std::optional<Packet> packet;
      outcome.status = reader.Read(rest, packet);
      if (!outcome.status.ok()) break;
      EXPECT_TRUE(packet || rest.empty());
      EXPECT_LT(rest.size(), before);
      if (packet) outcome.packets.push_back(*packet);
    }
  }
  outcome.at_boundary = reader.AtBoundary();
  outcome.position = reader.position();
  return outcome;
}

TEST(Packet, ComesBackInEveryChunking) {
  const std::size_t sizes[] = {0, 1, 31, 32, 33, 1000, 4095, 4096, 70000};
  Bytes stream = Magic();
  for (std::size_t i = 0; i < std::size(sizes); ++i) {
    Append(stream, WritePacket(static_cast<PacketType>(i % 4), Payload(sizes[i], i)));
  }
  for (const std::size_t chunk : {std::size_t{1}, std::size_t{7}, std::size_t{4096}, stream.size()}) {
    const Outcome outcome = Read(stream, chunk);
    ASSERT_TRUE(outcome.status.ok()) << outcome.status.message();
    ASSERT_EQ(outcome.packets.size(), std::size(sizes));
    for (std::size_t i = 0; i < std::size(sizes); ++i) {
      EXPECT_EQ(outcome.packets[i].type, static_cast<PacketType>(i % 4));
      EXPECT_EQ(outcome.packets[i].payload, Payload(sizes[i], i));
    }
    EXPECT_TRUE(outcome.at_boundary);
    EXPECT_EQ(outcome.position, stream.size());
  }
}

TEST(Packet, HasTheBytesOfTheDefinition) {
  EXPECT_EQ(WritePacket(PacketType::kEnd, {}).size(), 5u);
  const Bytes packet = WritePacket(PacketType::kGroup, Payload(32, 1));
  ASSERT_EQ(packet.size(), 2u + 32 + 4);
  EXPECT_EQ(packet[0], 0x80 | 2);  // 32 * 16 + 2 = 514
  EXPECT_EQ(packet[1], 4);
}

TEST(Packet, BoundariesAreKnown) {
  Bytes stream = Magic();
  const std::size_t first = stream.size();
  Append(stream, WritePacket(PacketType::kHeader, Payload(40, 1)));
  const std::size_t second = stream.size();
  Append(stream, WritePacket(PacketType::kEnd, Payload(1, 2)));
  for (std::size_t size = 0; size <= stream.size(); ++size) {
    const Outcome outcome = Read(Bytes(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size)), 7);
    EXPECT_TRUE(outcome.status.ok());
    EXPECT_EQ(outcome.at_boundary, size == first || size == second || size == stream.size()) << size;
    EXPECT_EQ(outcome.packets.size(), (size >= second ? 1u : 0u) + (size == stream.size() ? 1u : 0u));
  }
}

TEST(Packet, EveryFlippedBitIsNoticed) {
  Bytes stream = Magic();
  Append(stream, WritePacket(PacketType::kGroup, Payload(50, 3)));
  Append(stream, WritePacket(PacketType::kEnd, Payload(3, 4)));
  for (std::size_t bit = 0; bit < 8 * stream.size(); ++bit) {
    Bytes changed = stream;
    changed[bit / 8] ^= static_cast<std::uint8_t>(1 << (bit % 8));
    const Outcome outcome = Read(changed, changed.size());
    // A changed size may also leave the reader waiting for more.
    EXPECT_TRUE(!outcome.status.ok() || !outcome.at_boundary) << bit;
  }
}

TEST(Packet, OtherFilesAreRefusedAtOnce) {
  for (const char* text : {"PK\x03\x04", "solid", "SAD\x1a", "SAC\n"}) {
    const std::string s = text;
    EXPECT_EQ(Read(Bytes(s.begin(), s.end()), 1).status.code(), StatusCode::kCorrupt) << text;
  }
  EXPECT_EQ(Read({0}, 1).position, 0u);
}

TEST(Packet, AMalformedSizeIsRefused) {
  for (const Bytes& tag : {Bytes{0x80, 0}, Bytes{0xff, 0xff, 0xff, 0xff, 0xff}, Bytes{0xff, 0xff, 0xff, 0xff, 0x1f}}) {
    Bytes stream = Magic();
    Append(stream, tag);
    EXPECT_EQ(Read(stream, 1).status.code(), StatusCode::kCorrupt);
  }
}

TEST(Packet, OverTheLimitIsRefusedBeforeItArrives) {
  Limits limits;
  limits.expert.packet_bytes = 100;
  Bytes fits = Magic(), exceeds = Magic();
  Append(fits, WritePacket(PacketType::kGroup, Payload(100, 1)));
  Append(exceeds, WritePacket(PacketType::kGroup, Payload(101, 1)));
  EXPECT_EQ(Read(fits, 1, limits).packets.size(), 1u);
  const Outcome outcome = Read(exceeds, 1, limits);
  EXPECT_EQ(outcome.status.code(), StatusCode::kLimit);
  EXPECT_EQ(outcome.position, 4u + 2u);

  Bytes huge = Magic();
  Append(huge, {0xff, 0xff, 0xff, 0xff, 0x0f});
  EXPECT_EQ(Read(huge, huge.size()).status.code(), StatusCode::kLimit);
}

TEST(Packet, AnErrorStays) {
  Bytes stream = Magic();
  Append(stream, WritePacket(PacketType::kGroup, Payload(10, 1)));
  stream.back() ^= 1;
  PacketReader reader{Limits{}};
  std::optional<Packet> packet;
  std::span<const std::uint8_t> rest(stream);
  EXPECT_EQ(reader.Read(rest, packet).code(), StatusCode::kCorrupt);
  const Bytes good = WritePacket(PacketType::kEnd, Payload(1, 1));
  rest = good;
  EXPECT_EQ(reader.Read(rest, packet).code(), StatusCode::kCorrupt);
  EXPECT_FALSE(packet);
}

}  // namespace
}  // namespace sac

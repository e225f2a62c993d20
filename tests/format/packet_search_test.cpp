// SPDX-License-Identifier: Apache-2.0
#include "format/packet_search.h"

#include <gtest/gtest.h>

#include <random>

#include "format/crc32.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

Bytes Noise(std::mt19937& random, std::size_t size) {
  Bytes noise(size);
  for (std::uint8_t& b : noise) b = static_cast<std::uint8_t>(random());
  return noise;
}

// Where the first packet that is found ends; 0 if none is.
std::size_t Find(const Bytes& bytes, std::size_t chunk, Packet& found, const Limits& limits = {}) {
  PacketSearch search(limits);
  std::optional<Packet> packet;
  for (std::size_t at = 0; at < bytes.size();) {
    auto part = std::span(bytes).subspan(at, std::min(chunk, bytes.size() - at));
    const std::size_t before = part.size();
    search.Read(part, packet);
    at += before - part.size();
    if (!packet) continue;
    found = *packet;
    return at;
  }
  return 0;
}

TEST(PacketSearch, FindsAPacketInNoise) {
  std::mt19937 random(2);
  for (const std::size_t size : {1u, 31u, 32u, 5000u, 70000u}) {
    for (const std::size_t noise : {0u, 1u, 1000u, 100000u}) {
      const Bytes payload = Noise(random, size);
      const Bytes packet = WritePacket(PacketType::kGroup, payload);
      const Bytes bytes = Concatenated({Noise(random, noise), packet, Noise(random, 50)});
      for (const std::size_t chunk : {std::size_t{1}, std::size_t{17}, bytes.size()}) {
        Packet found;
        ASSERT_EQ(Find(bytes, chunk, found), noise + packet.size()) << size << " " << noise;
        EXPECT_EQ(found.payload, payload);
        EXPECT_EQ(found.type, PacketType::kGroup);
      }
    }
  }
}

TEST(PacketSearch, FindsNothingInNoise) {
  std::mt19937 random(3);
  Packet found;
  EXPECT_EQ(Find(Noise(random, 300000), 1000, found), 0u);
  EXPECT_EQ(Find(Bytes(100000, 0), 1000, found), 0u);
  EXPECT_EQ(Find(Bytes(100000, 0xff), 1000, found), 0u);
}

// The one that is complete first, which is not the one that begins first.
TEST(PacketSearch, TakesWhatIsCompleteFirst) {
  const Bytes inner = WritePacket(PacketType::kGroup, Bytes(20, 7)), outer = WritePacket(PacketType::kEnd, inner);
  Packet found;
  EXPECT_EQ(Find(outer, outer.size(), found), outer.size() - 4);
  EXPECT_EQ(found.payload, Bytes(20, 7));
}

TEST(PacketSearch, PassesOverWhatItDoesNotLookFor) {
  const Bytes i_frame = WritePacket(PacketType::kIFrame, Bytes(20, 7));
  Limits limits;
  limits.expert.packet_bytes = 30;
  const Bytes large = WritePacket(PacketType::kGroup, Bytes(31, 1)),
              good = WritePacket(PacketType::kHeader, Bytes(30, 2));
  Packet found;
  EXPECT_EQ(Find(Concatenated({i_frame, large, good}), 5, found, limits), i_frame.size() + large.size() + good.size());
  EXPECT_EQ(found.type, PacketType::kHeader);
}

TEST(Crc32, OfTheLastBytesIsHadFromTheSums) {
  std::mt19937 random(4);
  const Bytes bytes = Noise(random, 80000);
  const std::span<const std::uint8_t> all(bytes);
  for (const std::size_t last : {0u, 1u, 2u, 255u, 256u, 65535u, 65536u, 79999u, 80000u}) {
    EXPECT_EQ(Crc32OfLast(Crc32(all.first(all.size() - last)), Crc32(all), last), Crc32(all.last(last))) << last;
  }
  ByteWriter with;
  with.Bytes(all);
  with.U32(Crc32(all));
  EXPECT_EQ(Crc32(with.bytes()), kCrc32Residue);
}

}  // namespace
}  // namespace sac

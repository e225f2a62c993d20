// SPDX-License-Identifier: Apache-2.0
#include "format/packet_search.h"

#include <algorithm>
#include <utility>

#include "format/bytes.h"
#include "format/crc32.h"

namespace sac {
namespace {

constexpr std::size_t kTagBytes = 5;  // at most
constexpr std::uint64_t kTrimAfter = 1 << 16;
// Larger packets are not looked for: any byte may claim one, and would make us hold what follows.
constexpr std::uint32_t kMaxPayload = 1 << 24;
constexpr std::uint64_t kMemoryOfByte = 50;  // that is held: itself, and a candidate that begins there

}  // namespace

PacketSearch::PacketSearch(const Limits& limits)
    : max_payload_(static_cast<std::uint32_t>(
          std::min<std::uint64_t>({limits.expert.packet_bytes, kMaxPayload, limits.memory / kMemoryOfByte}))) {}

bool PacketSearch::TakeStart(const Start& start) {
  const std::span<const std::uint8_t> rest = std::span(held_).subspan(start.begin - held_from_);
  const std::size_t tag_bytes = std::min(rest.size(), kTagBytes);
  std::size_t size = 0;
  while (size < tag_bytes && (rest[size] & 0x80) != 0) ++size;
  if (size == tag_bytes) return tag_bytes == kTagBytes;  // five bytes that go on are no tag
  ByteReader reader(rest.first(size + 1));
  const std::uint32_t tag = reader.Varint(), payload = tag / kPacketTypes;
  const bool fits = reader.ok() && payload > 0 && payload <= max_payload_;
  const auto type = static_cast<PacketType>(tag % kPacketTypes);
  if (fits && (type == PacketType::kHeader || type == PacketType::kGroup || type == PacketType::kEnd)) {
    candidates_.push({start.begin, start.begin + PacketSize(payload), start.crc_before});
  }
  return true;
}

void PacketSearch::Read(std::span<const std::uint8_t>& bytes, std::optional<Packet>& packet) {
  packet.reset();
  while (!bytes.empty()) {
    starts_.push_back({position_, crc_});
    held_.push_back(bytes.front());
    crc_ = Crc32(bytes.first(1), crc_);
    bytes = bytes.subspan(1);
    ++position_;
    std::erase_if(starts_, [this](const Start& start) { return TakeStart(start); });
    for (; !candidates_.empty() && candidates_.top().end <= position_; candidates_.pop()) {
      const Candidate& c = candidates_.top();
      const std::uint64_t size = c.end - c.begin;
      if (Crc32OfLast(c.crc_before, crc_, size) != kCrc32Residue) continue;
      Packet found;
      if (!ParsePacket(std::span(held_).subspan(c.begin - held_from_, size), found)) continue;
      packet = std::move(found);
      return;
    }
    if (position_ % kTrimAfter == 0) Trim();
  }
}

void PacketSearch::Trim() {
  std::uint64_t first = starts_.empty() ? position_ : starts_.front().begin;
  // The queue is a heap by ends; what it holds begins no earlier than a packet's size ago.
  const std::uint64_t longest = PacketSize(max_payload_);
  if (!candidates_.empty()) first = std::min(first, position_ > longest ? position_ - longest : 0);
  if (first <= held_from_) return;
  held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(first - held_from_));
  held_from_ = first;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <queue>
#include <span>
#include <vector>

#include "format/packet.h"
#include "sac/limits.h"

namespace sac {

// Finds the next packet where packet borders are unknown, after damage or after joining a stream in the middle. The
// result is the first sequence header, group or end packet to be complete, at whatever byte it begins, whose CRC-32 is
// right. Every byte may begin a packet. The CRC-32 of each candidate follows from the CRC-32 of the bytes so far, so
// that time is linear in the bytes.
class PacketSearch {
 public:
  explicit PacketSearch(const Limits& limits);

  // Takes bytes from the front of `bytes` until a packet is complete, which ends the search, or until `bytes` is empty.
  // The search holds as many bytes as the largest packet it looks for, at tag_bytes 16 MB, and up to 50 bytes of memory
  // for each of them. It does not find larger packets.
  void Read(std::span<const std::uint8_t>& bytes, std::optional<Packet>& packet);

 private:
  struct Candidate {
    std::uint64_t begin, end;  // bytes of this search
    std::uint32_t crc_before;  // of the bytes before `begin`
    bool operator>(const Candidate& other) const { return end > other.end; }
  };
  struct Start {
    std::uint64_t begin;
    std::uint32_t crc_before;
  };

  // Whether the bytes from `start` on are a whole tag.
  bool TakeStart(const Start& start);
  // Drops bytes that no candidate needs.
  void Trim();

  std::uint32_t max_payload_;
  std::vector<std::uint8_t> held_;
  std::uint64_t held_from_ = 0, position_ = 0;
  std::uint32_t crc_ = 0;      // of all bytes of this search
  std::vector<Start> starts_;  // whose tags are not whole yet, at tag_bytes 5
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates_;
};

}  // namespace sac

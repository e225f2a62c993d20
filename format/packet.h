#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "format/limits.h"
#include "format/status.h"

namespace sac {

inline constexpr std::uint8_t kMagic[4] = {0x53, 0x41, 0x43, 0x1A};  // "SAC" and a control character

enum class PacketType : std::uint8_t {
  kHeader = 0,  // sequence header, first
  kIFrame = 1,  // the first frame's mesh and the basis, second
  kGroup = 2,   // frames
  kEnd = 3,     // number of frames, last
};

struct Packet {
  PacketType type;
  std::vector<std::uint8_t> payload;
};

// The bytes of a packet (spec.md 3): varint(payload size * 4 + type), payload, CRC-32 of both.
std::vector<std::uint8_t> WritePacket(PacketType type, std::span<const std::uint8_t> payload);

// Cuts a stream, which may arrive in any chunking, into packets. Holds the bytes of at most one packet.
class PacketReader {
 public:
  explicit PacketReader(const Limits& limits) : limits_(limits) {}

  // Takes bytes from the front of `bytes` until a packet is complete or `bytes` is empty; `packet` is empty in the
  // latter case. kCorrupt: not a .sac stream, a malformed tag or a wrong CRC; kLimit: a packet over the limit.
  Status Read(std::span<const std::uint8_t>& bytes, std::optional<Packet>& packet);

  // Whether the stream could end here: no packet has begun.
  bool AtBoundary() const { return magic_seen_ && pending_.empty(); }
  // Bytes taken so far.
  std::uint64_t position() const { return position_; }

 private:
  Limits limits_;
  std::vector<std::uint8_t> pending_;  // of the magic, then of a packet
  std::size_t needed_ = 0;             // bytes of the whole packet once its tag is known, else 0
  std::size_t tag_size_ = 0;
  std::uint32_t tag_ = 0;
  bool magic_seen_ = false;
  std::uint64_t position_ = 0;
};

}  // namespace sac

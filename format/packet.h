// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sac/limits.h"
#include "sac/status.h"

namespace sac {

inline constexpr std::uint8_t kMagic[4] = {0x53, 0x41, 0x43, 0x1A};  // "SAC" and a control character

enum class PacketType : std::uint8_t {
  kHeader = 0,  // sequence header, the first packet of a segment
  kIFrame = 1,  // a segment's mesh and basis, follows its header
  kGroup = 2,   // frames
  kLayer = 3,   // a layer of the frames of the group before
  kEnd = 4,     // number of frames, last
  // From here to kSkippable - 1, types that no decoder may pass over, for later versions.
  kReserved = 5,
  // From here on, types that a decoder may pass over.
  kSkippable = 8,
  kMetadata = 8,  // what the clip is called, its units and so on
  kSource = 9,    // the author's mesh as far as the stream does not hold it
  // Types of the records that follow the packet of an open group. Records have no tag.
  kFrame = 16,     // one frame of the open group
  kGroupEnd = 17,  // the end of the open group
};
inline constexpr std::uint32_t kPacketTypes = 16;  // that a tag has room for

inline bool IsSkippable(PacketType type) { return type >= PacketType::kSkippable && type < PacketType::kFrame; }

struct Packet {
  PacketType type = PacketType::kHeader;
  std::vector<std::uint8_t> payload;
};

// Returns the bytes of a packet (spec.md 3): varint(payload size * 16 + type), payload, CRC-32 of both.
std::vector<std::uint8_t> WritePacket(PacketType type, std::span<const std::uint8_t> payload);

// The size in bytes of a packet whose payload has `payload` bytes.
std::size_t PacketSize(std::size_t payload);

// Parses what WritePacket() writes. Returns false unless `bytes` are one whole packet with the right CRC-32.
bool ParsePacket(std::span<const std::uint8_t> bytes, Packet& packet);

// Writes the records of an open group, one for each frame as it comes (spec.md 3.1).
class RecordWriter {
 public:
  // Returns the packet that opens a group. `first_frame` is the number of its first frame in the clip, `segment` that
  // of its segment.
  std::vector<std::uint8_t> Open(std::uint32_t first_frame, std::uint32_t segment = 0);
  // Returns the record of a frame: varint(size + 1), the code, one byte of the CRC-32 of the group so far.
  std::vector<std::uint8_t> Frame(std::span<const std::uint8_t> code);
  // Returns the record that ends the group: varint(0), the CRC-32 of the group.
  std::vector<std::uint8_t> End();

 private:
  std::uint32_t crc_ = 0;
};

// The error of a stream that ends before its end packet, after `bytes` bytes and `frames` frames.
Status Truncated(std::uint64_t bytes, std::uint64_t frames);

// Cuts a stream, which may arrive in any chunking, into packets and the records of open groups. The reader holds the
// bytes of at most one packet or record.
class PacketReader {
 public:
  explicit PacketReader(const Limits& limits) : limits_(limits) {}

  // Takes bytes from the front of `bytes` until a packet is complete or `bytes` is empty; `packet` is empty in the
  // latter case. Returns kCorrupt when the bytes are no .sac stream, a tag is malformed or a CRC-32 is wrong,
  // kUnsupported when a packet is of a type that may not be passed over and is not known, and kLimit when a packet is
  // larger than the limit.
  Status Read(std::span<const std::uint8_t>& bytes, std::optional<Packet>& packet);

  // Whether the stream could end here: no packet has begun, no group is open.
  bool AtBoundary() const { return magic_seen_ && pending_.empty() && !in_open_group_; }
  // Continues at byte `position` of the stream, where a packet begins or, with `in_open_group`, the first record of an
  // open group.
  void Restart(std::uint64_t position, bool in_open_group);
  // Returns the bytes of a packet that has begun or whose CRC-32 is wrong, and forgets them.
  std::vector<std::uint8_t> TakePending();
  // The number of bytes taken so far.
  std::uint64_t position() const { return position_; }
  bool IsBetweenPackets() const { return pending_.empty(); }

 private:
  // Checks the pending tag or size of a record.
  Status TakeTag();
  // Checks the CRC-32 of the pending bytes and makes a packet of them.
  Status TakePacket(Packet& packet);

  Limits limits_;
  std::vector<std::uint8_t> pending_;  // of the magic, then of a packet or record
  std::size_t needed_ = 0;             // bytes of the whole packet once its tag is known, else 0
  std::size_t tag_size_ = 0;
  std::size_t crc_size_ = 4;
  PacketType type_ = PacketType::kHeader;
  bool in_open_group_ = false;
  std::uint32_t group_crc_ = 0;  // of the open group so far
  bool magic_seen_ = false;
  std::uint64_t position_ = 0;
};

}  // namespace sac

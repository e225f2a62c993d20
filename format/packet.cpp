// SPDX-License-Identifier: Apache-2.0
#include "format/packet.h"

#include <algorithm>
#include <string>
#include <utility>

#include "format/bytes.h"
#include "format/crc32.h"
#include "format/group.h"

namespace sac {

std::vector<std::uint8_t> WritePacket(PacketType type, std::span<const std::uint8_t> payload) {
  ByteWriter out;
  out.Varint(static_cast<std::uint32_t>(payload.size()) * kPacketTypes + static_cast<std::uint32_t>(type));
  out.Bytes(payload);
  out.U32(Crc32(out.bytes()));
  return std::move(out.bytes());
}

std::size_t PacketSize(std::size_t payload) {
  std::size_t size = payload + 5;
  for (std::uint64_t tag = std::uint64_t{payload} * kPacketTypes; tag >= 0x80; tag >>= 7) ++size;
  return size;
}

bool ParsePacket(std::span<const std::uint8_t> bytes, Packet& packet) {
  ByteReader reader(bytes);
  const std::uint32_t tag = reader.Varint();
  const std::span<const std::uint8_t> payload = reader.Bytes(tag / kPacketTypes);
  const std::uint32_t crc = Crc32(bytes.first(reader.position()));
  if (reader.U32() != crc || !reader.ok() || reader.remaining() != 0) return false;
  packet.type = static_cast<PacketType>(tag % kPacketTypes);
  packet.payload.assign(payload.begin(), payload.end());
  return true;
}

std::vector<std::uint8_t> RecordWriter::Open(std::uint32_t first_frame, std::uint32_t segment) {
  crc_ = 0;
  return WritePacket(PacketType::kGroup, WriteGroup({0, first_frame, 1, segment}, {}));
}

std::vector<std::uint8_t> RecordWriter::Frame(std::span<const std::uint8_t> code) {
  ByteWriter out;
  out.Varint(static_cast<std::uint32_t>(code.size()) + 1);
  out.Bytes(code);
  crc_ = Crc32(out.bytes(), crc_);
  out.U8(static_cast<std::uint8_t>(crc_));
  return std::move(out.bytes());
}

std::vector<std::uint8_t> RecordWriter::End() {
  ByteWriter out;
  out.Varint(0);
  crc_ = Crc32(out.bytes(), crc_);
  out.U32(crc_);
  return std::move(out.bytes());
}

Status Truncated(std::uint64_t bytes, std::uint64_t frames) {
  if (bytes == 0) return Status::Corrupt("the stream is empty");
  if (frames == 0) return Status::Corrupt("the stream is truncated before its first frame");
  return Status::Corrupt("the stream is truncated after frame " + std::to_string(frames));
}

void PacketReader::Restart(std::uint64_t position, bool in_open_group) {
  pending_.clear();
  needed_ = 0;
  in_open_group_ = in_open_group;
  group_crc_ = 0;
  magic_seen_ = true;
  position_ = position;
}

std::vector<std::uint8_t> PacketReader::TakePending() {
  needed_ = 0;
  return std::exchange(pending_, {});
}

Status PacketReader::TakeTag() {
  ByteReader reader(pending_);
  const std::uint32_t tag = reader.Varint();
  if (!reader.ok()) return Status::Corrupt("malformed packet size at byte " + std::to_string(position_));
  tag_size_ = pending_.size();
  std::uint32_t size = tag / kPacketTypes;
  crc_size_ = 4;
  if (!in_open_group_) {
    type_ = static_cast<PacketType>(tag % kPacketTypes);
    if (type_ >= PacketType::kReserved && type_ < PacketType::kSkippable) {
      return Status::Unsupported("a packet of type " + std::to_string(tag % kPacketTypes) + " at byte " +
                                 std::to_string(position_ - tag_size_));
    }
  } else if (tag == 0) {
    type_ = PacketType::kGroupEnd;
    size = 0;
  } else {
    type_ = PacketType::kFrame;
    size = tag - 1;
    crc_size_ = 1;
  }
  // It is held as it comes, with room to grow, and as a packet.
  if (const auto most = std::min<std::uint64_t>(limits_.expert.packet_bytes, limits_.memory / 4); size > most) {
    return Status::Limit("a packet of " + std::to_string(size) + " bytes, the limit is " + std::to_string(most));
  }
  needed_ = tag_size_ + size + crc_size_;
  return Status::Ok();
}

Status PacketReader::TakePacket(Packet& packet) {
  const std::span<const std::uint8_t> whole(pending_), checked = whole.first(needed_ - crc_size_);
  ByteReader reader(whole.last(crc_size_));
  const std::uint32_t crc = Crc32(checked, in_open_group_ ? group_crc_ : 0);
  const bool good = crc_size_ == 4 ? reader.U32() == crc : reader.U8() == (crc & 0xff);
  if (!good) return Status::Corrupt("wrong checksum in the packet that ends at byte " + std::to_string(position_));
  packet.type = type_;
  packet.payload.assign(checked.begin() + static_cast<std::ptrdiff_t>(tag_size_), checked.end());
  if (type_ == PacketType::kGroup) {
    in_open_group_ = OpensGroup(packet.payload);
    group_crc_ = 0;
  } else {
    if (type_ == PacketType::kGroupEnd) in_open_group_ = false;
    group_crc_ = crc;
  }
  pending_.clear();
  needed_ = 0;
  return Status::Ok();
}

Status PacketReader::Read(std::span<const std::uint8_t>& bytes, std::optional<Packet>& packet) {
  packet.reset();
  const auto take = [&](std::size_t count) {
    pending_.insert(pending_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    bytes = bytes.subspan(count);
    position_ += count;
  };
  while (!bytes.empty()) {
    if (!magic_seen_) {
      if (bytes.front() != kMagic[pending_.size()]) return Status::Corrupt("not a .sac stream");
      take(1);
      if (pending_.size() == 4) {
        magic_seen_ = true;
        pending_.clear();
      }
      continue;
    }
    if (needed_ == 0) {
      take(1);
      const bool last_byte = (pending_.back() & 0x80) == 0;
      if (last_byte || pending_.size() == 5) SAC_RETURN_IF_ERROR(TakeTag());
      continue;
    }
    take(std::min(bytes.size(), needed_ - pending_.size()));
    if (pending_.size() < needed_) continue;
    Packet taken;
    SAC_RETURN_IF_ERROR(TakePacket(taken));
    packet = std::move(taken);
    return Status::Ok();
  }
  return Status::Ok();
}

}  // namespace sac

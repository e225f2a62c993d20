#include "format/packet.h"

#include <algorithm>
#include <string>

#include "format/bytes.h"
#include "format/crc32.h"

namespace sac {

std::vector<std::uint8_t> WritePacket(PacketType type, std::span<const std::uint8_t> payload) {
  ByteWriter out;
  out.Varint(static_cast<std::uint32_t>(payload.size()) * 4 + static_cast<std::uint32_t>(type));
  out.Bytes(payload);
  out.U32(Crc32(out.bytes()));
  return std::move(out.bytes());
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
      if (!last_byte && pending_.size() < 5) continue;
      ByteReader reader(pending_);
      tag_ = reader.Varint();
      if (!reader.ok()) return Status::Corrupt("malformed packet size at byte " + std::to_string(position_));
      tag_size_ = pending_.size();
      if (tag_ / 4 > limits_.packet_bytes) {
        return Status::Limit("a packet of " + std::to_string(tag_ / 4) + " bytes, the limit is " +
                             std::to_string(limits_.packet_bytes));
      }
      needed_ = tag_size_ + tag_ / 4 + 4;
      continue;
    }
    take(std::min(bytes.size(), needed_ - pending_.size()));
    if (pending_.size() < needed_) continue;
    const std::span<const std::uint8_t> whole(pending_);
    ByteReader crc(whole.subspan(needed_ - 4));
    if (crc.U32() != Crc32(whole.first(needed_ - 4))) {
      return Status::Corrupt("wrong checksum in the packet that ends at byte " + std::to_string(position_));
    }
    packet.emplace(Packet{static_cast<PacketType>(tag_ & 3), {}});
    const auto payload = whole.subspan(tag_size_, needed_ - 4 - tag_size_);
    packet->payload.assign(payload.begin(), payload.end());
    pending_.clear();
    needed_ = 0;
    return Status::Ok();
  }
  return Status::Ok();
}

}  // namespace sac

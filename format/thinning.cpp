// SPDX-License-Identifier: Apache-2.0
#include "format/thinning.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "format/group.h"
#include "format/stream_index.h"

namespace sac {

Status StreamThinner::Take(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out) {
  while (!bytes.empty()) {
    if (ended_) return Status::Corrupt("bytes after the end of the stream");
    const std::span<const std::uint8_t> before = bytes;
    std::optional<Packet> packet;
    SAC_RETURN_IF_ERROR(reader_.Read(bytes, packet));
    const std::span<const std::uint8_t> taken = before.first(before.size() - bytes.size());
    raw_.insert(raw_.end(), taken.begin(), taken.end());
    if (!packet) continue;
    SAC_RETURN_IF_ERROR(Put(*packet, raw_, out));
    raw_.clear();
  }
  return Status::Ok();
}

Status StreamThinner::Put(const Packet& packet, std::span<const std::uint8_t> raw, std::vector<std::uint8_t>& out) {
  if (packet.type == PacketType::kGroup) dropped_bytes_.push_back(0);
  if (packet.type == PacketType::kLayer) {
    LayerSyntax layer;
    std::span<const std::uint8_t> code;
    SAC_RETURN_IF_ERROR(ParseLayer(packet.payload, layer, code));
    if (dropped_bytes_.empty()) return Status::Corrupt("a layer before the first group");
    if (layer.layer >= layers_) {
      dropped_bytes_.back() += static_cast<std::uint32_t>(raw.size());
      ++layers_dropped_;
      return Status::Ok();
    }
  }
  if (packet.type == PacketType::kEnd) {
    EndSyntax end;
    SAC_RETURN_IF_ERROR(ParseEnd(packet.payload, Limits{}, end));
    ended_ = true;
    if (end.index) {
      if (end.index->groups.size() != dropped_bytes_.size())
        return Status::Corrupt("end: the index is not the stream's");
      for (std::size_t i = 0; i < dropped_bytes_.size(); ++i) {
        std::uint32_t& size = end.index->groups[i].bytes;
        size -= std::min(size, dropped_bytes_[i]);
      }
      const std::vector<std::uint8_t> written = WritePacket(PacketType::kEnd, WriteEnd(end));
      out.insert(out.end(), written.begin(), written.end());
      return Status::Ok();
    }
  }
  out.insert(out.end(), raw.begin(), raw.end());
  return Status::Ok();
}

Status StreamThinner::Finish() const {
  return ended_ ? Status::Ok() : Truncated(reader_.position(), dropped_bytes_.size());
}

}  // namespace sac

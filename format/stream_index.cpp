// SPDX-License-Identifier: Apache-2.0
#include "format/stream_index.h"

#include <utility>

#include "format/bytes.h"
#include "format/packet.h"

namespace sac {
namespace {

constexpr std::uint64_t kIndexMemory = 64;  // of a group in it and in a table of places, while they grow

}  // namespace

std::vector<std::uint8_t> WriteEnd(const EndSyntax& end) {
  ByteWriter out;
  out.Varint(end.frames);
  if (end.index) {
    out.Varint(end.index->first_group);
    out.Varint(static_cast<std::uint32_t>(end.index->segments.size()));
    for (const StreamIndex::Segment& segment : end.index->segments) {
      out.Varint(segment.groups);
      out.Varint(segment.start);
    }
    for (const StreamIndex::Group& group : end.index->groups) {
      out.Varint(group.bytes);
      out.Varint(group.frames);
    }
    const std::size_t payload = out.size() + 4;
    out.U32(static_cast<std::uint32_t>(PacketSize(payload)));
  }
  return std::move(out.bytes());
}

Status ParseEnd(std::span<const std::uint8_t> payload, const Limits& limits, EndSyntax& end) {
  ByteReader reader(payload);
  end.frames = reader.Varint();
  if (!reader.ok()) return Status::Corrupt("end: malformed");
  if (reader.remaining() == 0) return Status::Ok();
  StreamIndex& index = end.index.emplace();
  index.first_group = reader.Varint();
  const std::uint32_t segments = reader.Varint();
  std::uint64_t frames = 0, before_last = 0;
  for (std::uint32_t i = 0; i < segments && reader.ok(); ++i) {
    StreamIndex::Segment& segment = index.segments.emplace_back();
    segment.groups = reader.Varint();
    segment.start = reader.Varint();
    before_last += segment.groups;
    if (segment.groups == 0) return Status::Corrupt("end: a segment without groups");
    if (index.segments.size() * kIndexMemory > limits.memory) return Status::Limit("an index larger than the limit");
  }
  while (reader.ok() && reader.remaining() > 4) {
    StreamIndex::Group group;
    group.bytes = reader.Varint();
    group.frames = reader.Varint();
    frames += group.frames;
    index.groups.push_back(group);
    if (index.groups.size() * kIndexMemory > limits.memory) return Status::Limit("an index larger than the limit");
  }
  const std::uint32_t size = reader.U32();
  if (!reader.ok() || reader.remaining() != 0) return Status::Corrupt("end: malformed index");
  const bool complete = size == PacketSize(payload.size()) && frames == end.frames;
  if (!complete || (segments > 0 && before_last >= index.groups.size())) return Status::Corrupt("end: a wrong index");
  return Status::Ok();
}

Status ReadIndex(std::span<const std::uint8_t> tail, const Limits& limits, StreamIndex& index, std::size_t& needed) {
  Status none = Status::InvalidArgument("the stream has no index, or is not whole");
  needed = kStreamTail;
  if (tail.size() < kStreamTail) return Status::NeedMoreData();
  ByteReader last(tail.last(kStreamTail));
  const std::uint32_t size = last.U32();
  if (size <= kStreamTail || size > PacketSize(limits.expert.packet_bytes)) return none;
  needed = size;
  if (tail.size() < size) return Status::NeedMoreData();
  Packet packet;
  EndSyntax end;
  if (!ParsePacket(tail.last(size), packet) || packet.type != PacketType::kEnd) return none;
  SAC_RETURN_IF_ERROR(ParseEnd(packet.payload, limits, end));
  if (!end.index) return none;
  index = std::move(*end.index);
  return Status::Ok();
}

}  // namespace sac

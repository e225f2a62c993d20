// SPDX-License-Identifier: Apache-2.0
#include "format/group_syntax.h"

#include <utility>

#include "format/bytes.h"

namespace sac {

std::vector<std::uint8_t> WriteGroup(const GroupSyntax& group, std::span<const std::uint8_t> code) {
  ByteWriter out;
  out.Varint(group.frames);
  out.Varint(group.first_frame);
  if (!group.open()) out.Varint(group.pyramid);
  out.Bytes(code);
  return std::move(out.bytes());
}

Status ParseGroup(std::span<const std::uint8_t> payload, GroupSyntax& group, std::span<const std::uint8_t>& code) {
  ByteReader reader(payload);
  group.frames = reader.Varint();
  group.first_frame = reader.Varint();
  group.pyramid = group.open() ? 1 : reader.Varint();
  if (!reader.ok() || group.pyramid == 0) return Status::Corrupt("group: malformed");
  if (group.open() && reader.remaining() > 0) return Status::Corrupt("group: an open group with bytes of its own");
  if (group.frames > 0xffffffffu - group.first_frame) return Status::Corrupt("group: too many frames");
  code = payload.subspan(reader.position());
  return Status::Ok();
}

bool OpensGroup(std::span<const std::uint8_t> payload) { return !payload.empty() && payload[0] == 0; }

}  // namespace sac

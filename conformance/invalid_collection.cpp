// SPDX-License-Identifier: Apache-2.0
#include "conformance/invalid_collection.h"

#include <optional>

#include "format/stream_index.h"

namespace sac {

void Collection::Add(const char* rule, const char* name, Bytes stream, const char* status) {
  vectors.push_back({rule, name, status, std::move(stream)});
}

void Collection::Change(const char* rule, const char* name, const std::function<void(StreamParts&)>& change,
                        const char* status) {
  StreamParts parts = SmallStream();
  change(parts);
  Add(rule, name, parts.Join(), status);
}

void Collection::ChangePackets(const char* rule, const char* name,
                               const std::function<void(std::vector<std::pair<PacketType, Bytes>>&)>& change) {
  const StreamParts parts = SmallStream();
  std::vector<std::pair<PacketType, Bytes>> packets = {
      {PacketType::kHeader, WriteSequenceHeader(parts.header)},
      {PacketType::kIFrame, WriteIFrame(parts.i_frame, parts.header)},
      {PacketType::kGroup, parts.groups[0]},
      {PacketType::kEnd, WriteEnd({parts.frames, std::nullopt})},
  };
  change(packets);
  Bytes stream = Magic();
  for (const auto& [type, payload] : packets) AppendPacket(stream, type, payload);
  Add(rule, name, stream);
}

void Collection::ChangeGroup(const char* rule, const char* name, std::uint32_t frames, std::uint32_t pyramid,
                             const std::function<void(std::uint32_t, FrameSyntax&)>& fill, std::uint8_t reference_shape,
                             const char* status) {
  Change(
      rule, name,
      [&](StreamParts& p) {
        p.header.reference_shape = reference_shape;
        p.groups = {CodeGroup(p, frames, pyramid, fill)};
        p.frames = frames;
      },
      status);
}

}  // namespace sac

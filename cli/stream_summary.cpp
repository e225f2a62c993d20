// SPDX-License-Identifier: Apache-2.0
#include "cli/stream_summary.h"

#include <algorithm>
#include <span>

#include "codec/draco_mesh.h"
#include "format/group.h"
#include "format/i_frame_syntax.h"
#include "format/metadata.h"
#include "format/range_coder.h"
#include "format/stream_index.h"
#include "sac/limits.h"

namespace sac {
namespace {

Status TakeIFrame(std::span<const std::uint8_t> payload, StreamSummary& summary) {
  IFrameSyntax syntax;
  RangeDecoder positions({});
  SAC_RETURN_IF_ERROR(ParseIFrame(payload, *summary.header, syntax, positions));
  DracoMesh mesh;  // holds the texture coordinates, if any; much quicker than harmonics
  SAC_RETURN_IF_ERROR(DecodeDraco(syntax.mesh, *summary.header, mesh));
  summary.i_frame = {syntax.harmonics.size(), !mesh.uv_triangles.empty(), syntax.has_normals, syntax.has_colors,
                     !syntax.order.empty()};
  return Status::Ok();
}

// The same order of packets that the decoder asks for.
Status Take(const Packet& packet, PacketSummary& line, StreamSummary& summary) {
  GroupSyntax group;
  std::span<const std::uint8_t> code;
  EndSyntax end;
  switch (packet.type) {
    case PacketType::kHeader: {
      if (summary.header) return Status::Ok();  // the start comes again
      SequenceHeader header;
      SAC_RETURN_IF_ERROR(ParseSequenceHeader(packet.payload, Limits{}, header));
      summary.header = header;
      return Status::Ok();
    }
    case PacketType::kIFrame:
      if (!summary.header) return Status::Corrupt("an I-frame out of place");
      if (summary.i_frame) return Status::Ok();
      return TakeIFrame(packet.payload, summary);
    case PacketType::kGroup:
      if (!summary.i_frame) return Status::Corrupt("a group before the I-frame");
      SAC_RETURN_IF_ERROR(ParseGroup(packet.payload, group, code));
      line.low_delay = group.open();
      line.layers = group.layered() ? 1 : 0;
      line.segment = group.segment;
      summary.segments = std::max(summary.segments, group.segment + 1);
      line.frames = group.frames;
      summary.frames += line.frames;
      return Status::Ok();
    case PacketType::kEnd:
      if (!summary.i_frame) return Status::Corrupt("the end before the I-frame");
      summary.ended = true;
      SAC_RETURN_IF_ERROR(ParseEnd(packet.payload, {}, end));
      summary.has_index = end.index.has_value();
      if (end.frames != summary.frames) {
        return Status::Corrupt("end: " + std::to_string(end.frames) + " frames declared, " +
                               std::to_string(summary.frames) + " found");
      }
      return Status::Ok();
    case PacketType::kFrame:
      line.frames = 1;
      ++summary.frames;
      return Status::Ok();
    case PacketType::kLayer:
      return summary.i_frame ? Status::Ok() : Status::Corrupt("a layer before the I-frame");
    case PacketType::kMetadata:
      // Nothing depends on it: what is malformed is left out.
      (void)ParseMetadata(packet.payload, summary.metadata).ok();
      return Status::Ok();
    default:
      return Status::Ok();
  }
}

}  // namespace

Status Summarize(StreamInput& input, StreamSummary& summary) {
  const auto at = [&input](const Status& s) { return Status(s.code(), input.name() + ": " + s.message()); };
  PacketReader reader(Limits{});
  std::uint64_t begin = 4;  // after the magic
  for (std::span<const std::uint8_t> chunk;;) {
    if (chunk.empty()) SAC_RETURN_IF_ERROR(input.Read(chunk));
    if (chunk.empty()) break;
    if (summary.ended) return at(Status::Corrupt("bytes after the end of the stream"));
    std::optional<Packet> packet;
    const Status read = reader.Read(chunk, packet);
    summary.bytes = reader.position();
    if (!read.ok()) return at(read);
    if (!packet) continue;
    PacketSummary line{packet->type, reader.position() - begin};
    begin = reader.position();
    if (const Status s = Take(*packet, line, summary); !s.ok()) return at(s);
    const bool is_layer = packet->type == PacketType::kLayer;
    if (!is_layer && packet->type != PacketType::kFrame && packet->type != PacketType::kGroupEnd) {
      summary.packets.push_back(line);
      continue;
    }
    summary.packets.back().bytes += line.bytes;  // of the group
    summary.packets.back().frames += line.frames;
    if (is_layer) ++summary.packets.back().layers;
  }
  if (summary.ended) return Status::Ok();
  return at(Truncated(summary.bytes, summary.frames));
}

const char* NameOf(PacketType type) {
  switch (type) {
    case PacketType::kHeader:
      return "header";
    case PacketType::kIFrame:
      return "i_frame";
    case PacketType::kGroup:
    case PacketType::kLayer:
    case PacketType::kFrame:
    case PacketType::kGroupEnd:
      return "group";
    case PacketType::kEnd:
      return "end";
    case PacketType::kMetadata:
      return "metadata";
    case PacketType::kSource:
      return "source";
    default:
      return "other";
  }
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "conformance/coefficients.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "codec/draco_mesh.h"
#include "codec/i_frame.h"
#include "format/bytes.h"
#include "format/crc32.h"
#include "format/frame_coder.h"
#include "format/group.h"
#include "format/i_frame_syntax.h"
#include "format/packet.h"
#include "format/range_coder.h"

namespace sac {
namespace {

std::uint32_t Add(std::span<const std::int32_t> values, std::uint32_t crc) {
  ByteWriter bytes;
  for (const std::int32_t v : values) bytes.U32(static_cast<std::uint32_t>(v));
  return Crc32(bytes.bytes(), crc);
}

Status ParseLayouts(std::span<const std::uint8_t> payload, const SequenceHeader& header, PlaneLayouts& layouts) {
  IFrameSyntax syntax;
  RangeDecoder positions({});
  SAC_RETURN_IF_ERROR(ParseIFrame(payload, header, syntax, positions));
  DracoMesh draco;
  SAC_RETURN_IF_ERROR(DecodeDraco(syntax.mesh, header, draco));
  DecodedIFrame decoded;
  SAC_RETURN_IF_ERROR(AssembleIFrame(syntax, header, std::move(draco), positions, decoded));
  std::vector<std::uint32_t> patch_sizes;
  for (const Component& patch : decoded.mesh.patches) patch_sizes.push_back(patch.count);
  layouts = LayOutPlanes(header, syntax.harmonics, patch_sizes);
  return Status::Ok();
}

using TakeFrame = std::function<void(const FrameSlot&, const FrameCoefficients&)>;

Status ReadGroup(std::span<const std::uint8_t> payload, const SequenceHeader& header, const PlaneLayouts& layouts,
                 const TakeFrame& take) {
  GroupSyntax group;
  std::span<const std::uint8_t> code;
  SAC_RETURN_IF_ERROR(ParseGroup(payload, group, code));
  RangeDecoder range(code);
  FrameCoder<RangeDecoder> coder(header, layouts);
  std::vector<FrameSlot> slots = GroupStructure(group.frames, group.pyramid);
  std::vector<std::size_t> slot_of(group.frames);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    FrameSyntax frame;
    if (!coder.Code(range, slots[i], frame)) return Status::Corrupt("malformed frame");
    slots[i] = frame.slot;
    slot_of[slots[i].display] = i;
  }
  for (const std::size_t slot : slot_of) take(slots[slot], coder.predictor().frames()[slot]);
  return Status::Ok();
}

// A layered group whose layers are being collected.
struct LayeredGroup {
  GroupSyntax group;
  std::vector<std::vector<std::uint8_t>> codes;
};

Status ReadLayers(const LayeredGroup& layered, const SequenceHeader& header, const PlaneLayouts& layouts,
                  const TakeFrame& take) {
  const GroupSyntax& group = layered.group;
  FrameCoder<RangeDecoder> coder(header, layouts);
  std::vector<FrameSlot> slots = LayeredOrder(GroupStructure(group.frames, group.pyramid), group.base_levels);
  const std::vector<GroupLayer> layers = LayersOf(slots, group.base_levels, layouts);
  std::size_t coded = 0;
  for (std::size_t l = 0; l < layered.codes.size(); ++l) {
    RangeDecoder range(layered.codes[l]);
    for (std::size_t i = layers[l].first; i < layers[l].end; ++i) {
      FrameSyntax frame;
      const bool good = layers[l].has_frames() ? coder.CodeBase(range, slots[i], frame)
                                               : coder.CodeLater(range, i, layers[l].plane, frame);
      if (!good) return Status::Corrupt("malformed frame");
      slots[i] = frame.slot;
      coded = std::max(coded, layers[l].end);
    }
  }
  for (; coded < slots.size(); ++coded) {
    if (!coder.Skip(slots[coded])) return Status::Corrupt("malformed frame");
  }
  std::vector<std::size_t> slot_of(group.frames);
  for (std::size_t i = 0; i < slots.size(); ++i) slot_of[slots[i].display] = i;
  for (const std::size_t slot : slot_of) take(slots[slot], coder.predictor().frames()[slot]);
  return Status::Ok();
}

Status ReadFrame(std::span<const std::uint8_t> payload, FrameCoder<RangeDecoder>& coder, const TakeFrame& take) {
  RangeDecoder range(payload);
  FrameSyntax frame;
  const FrameSlot slot = ChainSlot(static_cast<std::uint32_t>(coder.predictor().frames().size()));
  if (!coder.Code(range, slot, frame)) return Status::Corrupt("malformed frame");
  take(frame.slot, coder.predictor().frames().back());
  return Status::Ok();
}

}  // namespace

std::uint32_t CoefficientsCrc32(const FrameCoefficients& coefficients, std::uint32_t crc) {
  crc = Add(coefficients.rigid, crc);
  for (const PlaneValues& plane : coefficients.planes) crc = Add(plane, crc);
  return crc;
}

Status CoefficientsCrc32(std::span<const std::uint8_t> stream, std::uint32_t& crc) {
  crc = 0;
  return ReadCoefficients(stream,
                          [&crc](const FrameSlot&, const FrameCoefficients& c) { crc = CoefficientsCrc32(c, crc); });
}

Status ReadCoefficients(std::span<const std::uint8_t> stream, const TakeFrame& take) {
  const Limits limits;
  PacketReader packets(limits);
  SequenceHeader header;
  PlaneLayouts layouts;
  std::optional<FrameCoder<RangeDecoder>> open;
  std::optional<LayeredGroup> layered;
  while (!stream.empty()) {
    std::optional<Packet> packet;
    SAC_RETURN_IF_ERROR(packets.Read(stream, packet));
    if (!packet) break;
    if (packet->type == PacketType::kLayer && layered) {
      LayerSyntax layer;
      std::span<const std::uint8_t> code;
      SAC_RETURN_IF_ERROR(ParseLayer(packet->payload, layer, code));
      layered->codes.emplace_back(code.begin(), code.end());
      continue;
    }
    if (layered && !IsSkippable(packet->type)) {
      SAC_RETURN_IF_ERROR(ReadLayers(*layered, header, layouts, take));
      layered.reset();
    }
    if (packet->type == PacketType::kHeader) SAC_RETURN_IF_ERROR(ParseSequenceHeader(packet->payload, limits, header));
    if (packet->type == PacketType::kIFrame) SAC_RETURN_IF_ERROR(ParseLayouts(packet->payload, header, layouts));
    if (packet->type == PacketType::kFrame) SAC_RETURN_IF_ERROR(ReadFrame(packet->payload, *open, take));
    if (packet->type != PacketType::kGroup) continue;
    GroupSyntax group;
    std::span<const std::uint8_t> code;
    SAC_RETURN_IF_ERROR(ParseGroup(packet->payload, group, code));
    if (group.open()) {
      open.emplace(header, layouts);
    } else if (group.layered()) {
      layered.emplace(LayeredGroup{group, {{code.begin(), code.end()}}});
    } else {
      SAC_RETURN_IF_ERROR(ReadGroup(packet->payload, header, layouts, take));
    }
  }
  return packets.AtBoundary() ? Status::Ok() : Status::Corrupt("truncated");
}

}  // namespace sac

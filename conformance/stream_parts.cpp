// SPDX-License-Identifier: Apache-2.0
#include "conformance/stream_parts.h"

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include "codec/draco_mesh.h"
#include "codec/i_frame.h"
#include "codec/shape.h"
#include "format/bytes.h"
#include "format/frame_coder.h"
#include "format/group.h"
#include "format/packet.h"
#include "format/stream_index.h"

namespace sac {
namespace {

void Require(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "make_vectors: %s\n", status.message().c_str());
  std::exit(1);
}

}  // namespace

Bytes Magic() { return {std::begin(kMagic), std::end(kMagic)}; }

void AppendPacket(Bytes& stream, PacketType type, const Bytes& payload) {
  const Bytes packet = WritePacket(type, payload);
  stream.insert(stream.end(), packet.begin(), packet.end());
}

Bytes StreamParts::Join() const {
  Bytes stream = Magic();
  AppendPacket(stream, PacketType::kHeader, WriteSequenceHeader(header));
  AppendPacket(stream, PacketType::kIFrame, WriteIFrame(i_frame, header));
  for (const Bytes& group : groups) AppendPacket(stream, PacketType::kGroup, group);
  for (const Bytes& group : open_groups) stream.insert(stream.end(), group.begin(), group.end());
  AppendPacket(stream, PacketType::kEnd, WriteEnd({frames, std::nullopt}));
  return stream;
}

Bytes Encode(const Clip& clip, const EncoderSettings& settings) {
  std::unique_ptr<Encoder> encoder;
  Require(Encoder::Create(clip.mesh, settings, encoder));
  for (const Positions& frame : clip.frames) Require(encoder->Send(frame));
  Require(encoder->Finish());
  return encoder->TakeBytes();
}

StreamParts Split(const Bytes& stream) {
  const Limits limits;
  StreamParts parts;
  PacketReader packets(limits);
  for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
    std::optional<Packet> packet;
    Require(packets.Read(rest, packet));
    if (!packet) break;
    EndSyntax end;
    switch (packet->type) {
      case PacketType::kHeader:
        Require(ParseSequenceHeader(packet->payload, limits, parts.header));
        break;
      case PacketType::kIFrame:
        Require(ReadIFrame(packet->payload, parts.header, parts.i_frame));
        break;
      case PacketType::kGroup:
        parts.groups.push_back(packet->payload);
        break;
      case PacketType::kEnd:
        Require(ParseEnd(packet->payload, {}, end));
        parts.frames = end.frames;
        break;
      default:
        break;
    }
  }
  return parts;
}

void Derive(StreamParts& parts) {
  DracoMesh draco;
  DecodedIFrame decoded;
  Shape shape;
  Require(DecodeDraco(parts.i_frame.mesh, parts.header, draco));
  Require(AssembleIFrame(parts.i_frame, parts.header, std::move(draco), decoded));
  Require(BuildShape(parts.header, std::move(decoded.mesh), parts.i_frame.harmonics, parts.i_frame.handles_per_harmonic,
                     Limits{}, shape));
  parts.i_frame.fingerprint = Fingerprint(shape.basis, shape.patch_basis);
  parts.layouts = shape.layouts;
}

Bytes CodeGroup(const StreamParts& parts, std::uint32_t frames, std::uint32_t pyramid,
                const std::function<void(std::uint32_t, FrameSyntax&)>& fill, std::uint32_t first_frame) {
  RangeEncoder range;
  FrameCoder<RangeEncoder> coder(parts.header, parts.layouts);
  std::uint32_t index = 0;
  for (const FrameSlot& slot : GroupStructure(frames, pyramid)) {
    FrameSyntax frame;
    frame.slot = slot;
    frame.planes = EmptyPlanes(parts.layouts);
    fill(index++, frame);
    if (!coder.Code(range, slot, frame)) break;
  }
  return WriteGroup({frames, first_frame, pyramid}, range.Finish());
}

std::vector<Bytes> CodeLayeredGroup(const StreamParts& parts, const GroupSyntax& group,
                                    const std::function<void(std::uint32_t, FrameSyntax&)>& fill) {
  FrameCoder<RangeEncoder> coder(parts.header, parts.layouts);
  const std::vector<FrameSlot> slots = LayeredOrder(GroupStructure(group.frames, group.pyramid), group.base_levels);
  std::vector<FrameSyntax> frames;
  for (const FrameSlot& slot : slots) {
    frames.push_back({slot, {}, EmptyPlanes(parts.layouts)});
    fill(static_cast<std::uint32_t>(frames.size() - 1), frames.back());
  }
  std::vector<Bytes> payloads;
  for (const GroupLayer& layer : LayersOf(slots, group.base_levels, parts.layouts)) {
    RangeEncoder range;
    for (std::size_t i = layer.first; i < layer.end; ++i) {
      const bool good = layer.has_frames() ? coder.CodeBase(range, slots[i], frames[i])
                                           : coder.CodeLater(range, i, layer.plane, frames[i]);
      if (!good) std::exit(1);
    }
    const Bytes code = range.Finish();
    const auto number = static_cast<std::uint32_t>(payloads.size());
    payloads.push_back(number == 0 ? WriteGroup(group, code) : WriteLayer({group.first_frame, number}, code));
  }
  return payloads;
}

Bytes CodeOpenGroup(const StreamParts& parts, std::uint32_t frames,
                    const std::function<void(std::uint32_t, FrameSyntax&)>& fill, std::uint32_t first_frame) {
  RecordWriter records;
  ByteWriter out;
  out.Bytes(records.Open(first_frame));
  FrameCoder<RangeEncoder> coder(parts.header, parts.layouts);
  for (std::uint32_t index = 0; index < frames; ++index) {
    FrameSyntax frame;
    frame.slot = ChainSlot(index);
    frame.planes = EmptyPlanes(parts.layouts);
    fill(index, frame);
    RangeEncoder range;
    if (!coder.Code(range, ChainSlot(index), frame)) std::exit(1);
    out.Bytes(records.Frame(range.Finish()));
  }
  out.Bytes(records.End());
  return out.bytes();
}

void FillAtRandom(std::mt19937& random, const References* references, std::uint32_t index, FrameSyntax& frame) {
  const auto residual = [&](std::uint32_t one_in, int most_bits) {
    std::int32_t value = 0;
    for (int bit = 0; bit < most_bits && random() % one_in == 0; ++bit) {
      value = 2 * value + 1 + static_cast<std::int32_t>(random() % 2);
    }
    return random() % 2 ? value : -value;
  };
  if (references) {
    frame.slot.references = *references;
  } else if (index > 0 && random() % 2) {
    frame.slot.references.resize(random() % 3);
    for (std::uint32_t& r : frame.slot.references) r = random() % index;
  }
  if (random() % 4 == 0) return;
  const std::uint32_t one_in = 2 + random() % 5;
  for (std::int32_t& r : frame.rigid) r = residual(2, 9);
  for (PlaneValues& plane : frame.planes) {
    if (plane.empty() || random() % 3 == 0) continue;
    for (std::int32_t& r : plane) r = residual(one_in, 8);
    if (random() % 4 == 0) plane[random() % plane.size()] = random() % 2 ? 1 << 16 : -(1 << 16);
  }
}

StreamParts SmallStream() {
  StreamParts parts;
  SequenceHeader& h = parts.header;
  h.reference_shape = 0;
  h.position_bits = 4;
  h.level_growth = 80;
  h.vertices = 4;
  h.triangles = 2;
  h.harmonics = 3;
  h.patch_size = 2;
  h.frame_rate_numerator = 25;
  h.frame_rate_denominator = 1;
  h.origin_x = -1;
  h.cell = 0.25f;
  h.motion_step = 0.0625f;
  h.displacement_step = 0.125f;
  h.detail_step = 0.0625f;
  h.correction_step = 0.03125f;
  h.rotation_step = 0.125f;
  h.translation_step = 0.5f;
  // A square with one corner bent. Vertices 1 and 2 change places, since vertices are ordered by patches.
  for (const std::array<std::uint32_t, 3>& g : {std::array{0u, 0u, 0u}, {8u, 7u, 0u}, {8u, 0u, 0u}, {0u, 9u, 3u}}) {
    parts.i_frame.loose_vertices.push_back({g, {}, {}});
  }
  parts.i_frame.loose_triangles = {{0, 2, 1}, {0, 1, 3}};
  parts.i_frame.harmonics = {3};
  Derive(parts);
  parts.frames = 3;
  parts.groups.push_back(CodeGroup(parts, 3, 2, [](std::uint32_t i, FrameSyntax& frame) {
    if (i == 1) {  // frame 2: turned, moved, bent
      frame.rigid = {0, 0, 4, 1, 0, -2};
      frame.planes[kMotion][9 + 0] = 3;
      frame.planes[kMotion][9 + 3] = -1;
      frame.planes[kDisplacement][2] = 1;
      frame.planes[kDisplacement][8] = 17;
      frame.planes[kDetail][3] = -4;
      frame.planes[kCorrection][11] = 2;
    }
    if (i == 2) frame.planes[kMotion][18 + 1] = -2;  // frame 1: the mean of frames 0 and 2, and a residual
  }));
  return parts;
}

}  // namespace sac

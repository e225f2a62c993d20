// SPDX-License-Identifier: Apache-2.0
// Everything before numerics: packets in chunks, headers, I-frames, and frames whose planes are laid out as if the
// I-frame's components were known. What is parsed is written again, and must be the same.
#include <algorithm>
#include <optional>
#include <vector>

#include "format/frame_coder.h"
#include "format/group.h"
#include "format/i_frame_syntax.h"
#include "format/metadata.h"
#include "format/packet.h"
#include "format/range_coder.h"
#include "format/sequence_header.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/stream_mutation.h"

namespace {

using namespace sac;

void ReadPackets(std::span<const std::uint8_t> stream, std::size_t chunk) {
  PacketReader reader(FuzzLimits());
  std::uint64_t taken = 0;
  while (!stream.empty()) {
    const std::vector<std::uint8_t> part(stream.begin(),
                                         stream.begin() + static_cast<std::ptrdiff_t>(std::min(chunk, stream.size())));
    stream = stream.subspan(part.size());
    for (std::span<const std::uint8_t> rest(part); !rest.empty();) {
      const std::size_t before = rest.size();
      std::optional<Packet> packet;
      if (!reader.Read(rest, packet).ok()) return;
      FUZZ_REQUIRE(packet || rest.empty());
      FUZZ_REQUIRE(rest.size() < before);
      taken += before - rest.size();
      FUZZ_REQUIRE(reader.position() == taken);
    }
  }
}

// Frames of a group, and the end of its code.
struct Frames {
  std::vector<FrameSyntax> list;
  bool whole = false;
};

template <class Slots>
Frames ReadFrames(std::span<const std::uint8_t> code, const SequenceHeader& header, const PlaneLayouts& layouts,
                  const Slots& slots) {
  Frames frames;
  RangeDecoder range(code);
  FrameCoder<RangeDecoder> coder(header, layouts);
  for (const FrameSlot& slot : slots) {
    FrameSyntax frame;
    if (!coder.Code(range, slot, frame)) return frames;
    for (const std::uint32_t r : frame.slot.references) FUZZ_REQUIRE(r < frames.list.size());
    frames.list.push_back(std::move(frame));
  }
  frames.whole = range.AtEnd();
  return frames;
}

void ReadGroup(std::span<const std::uint8_t> payload, const SequenceHeader& header, const PlaneLayouts& layouts) {
  GroupSyntax group;
  std::span<const std::uint8_t> bytes;
  if (!ParseGroup(payload, group, bytes).ok()) return;
  FUZZ_REQUIRE(WriteGroup(group, bytes) == Bytes(payload.begin(), payload.end()));
  const std::uint32_t frames = group.frames;
  if (group.open() || group.layered() || frames > FuzzLimits().expert.frames_per_group) return;
  const std::vector<FrameSlot> slots = GroupStructure(frames, group.pyramid);
  FUZZ_REQUIRE(slots.size() == frames);
  const Frames read = ReadFrames(bytes, header, layouts, slots);
  if (!read.whole) return;
  RangeEncoder range;
  FrameCoder<RangeEncoder> coder(header, layouts);
  for (std::size_t i = 0; i < frames; ++i) {
    FrameSyntax frame = read.list[i];
    FUZZ_REQUIRE(coder.Code(range, slots[i], frame));
  }
  const std::vector<std::uint8_t> code = range.Finish();
  const Frames again = ReadFrames(code, header, layouts, slots);
  FUZZ_REQUIRE(again.whole);
  for (std::size_t i = 0; i < frames; ++i) {
    FUZZ_REQUIRE(again.list[i].slot.references == read.list[i].slot.references);
    FUZZ_REQUIRE(again.list[i].rigid == read.list[i].rigid && again.list[i].planes == read.list[i].planes);
  }
}

PlaneLayouts LayOut(const SequenceHeader& header, const IFrameSyntax& syntax) {
  std::vector<std::uint32_t> patches;
  for (std::uint32_t left = header.vertices; left > 0; left -= patches.back()) {
    patches.push_back(std::min(left, header.patch_size));
  }
  return LayOutPlanes(header, syntax.harmonics, patches);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> input(data, size);
  ReadPackets(input, 1 + size % 64);
  const Bytes repaired = Repaired(input);
  ReadPackets(repaired, 1 + size % 61);

  std::optional<SequenceHeader> header;
  std::optional<PlaneLayouts> layouts;
  for (const Packet& packet : CutPackets(repaired)) {
    if (packet.type == PacketType::kHeader) {
      SequenceHeader parsed;
      if (!ParseSequenceHeader(packet.payload, FuzzLimits(), parsed).ok()) continue;
      FUZZ_REQUIRE(WriteSequenceHeader(parsed) == packet.payload);
      header = parsed;
      layouts.reset();
    } else if (packet.type == PacketType::kIFrame && header) {
      IFrameSyntax syntax;
      RangeDecoder positions({});
      if (!ParseIFrame(packet.payload, *header, syntax, positions).ok()) continue;
      const Bytes written = WriteIFrame(syntax, *header);
      IFrameSyntax again;
      FUZZ_REQUIRE(ParseIFrame(written, *header, again, positions).ok() && positions.AtEnd());
      FUZZ_REQUIRE(WriteIFrame(again, *header) == written);
      layouts = LayOut(*header, syntax);
    } else if (packet.type == PacketType::kGroup && layouts) {
      ReadGroup(packet.payload, *header, *layouts);
    } else if (packet.type == PacketType::kLayer) {
      LayerSyntax layer;
      std::span<const std::uint8_t> code;
      if (ParseLayer(packet.payload, layer, code).ok()) FUZZ_REQUIRE(WriteLayer(layer, code) == packet.payload);
    } else if (packet.type == PacketType::kMetadata) {
      Metadata metadata, again;
      if (!ParseMetadata(packet.payload, metadata).ok()) continue;
      const Bytes written = WriteMetadata(metadata);
      FUZZ_REQUIRE(ParseMetadata(written, again).ok() && WriteMetadata(again) == written);
    } else if (packet.type == PacketType::kFrame && layouts) {
      const std::vector<FrameSlot> slots = {ChainSlot(0)};
      (void)ReadFrames(packet.payload, *header, *layouts, slots);
    }
  }
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
#include "conformance/valid_packets.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>

#include "conformance/stream_parts.h"
#include "format/bytes.h"
#include "format/frame_coder.h"
#include "format/group.h"
#include "format/metadata.h"
#include "format/range_coder.h"
#include "format/stream_index.h"

namespace sac {
namespace {

// A stream with groups of all kinds, one of them without frames, in which the start is repeated and an index stands at
// the end. It is coded without Draco.
Bytes RepeatedStart() {
  StreamParts parts = SmallStream();
  const auto still = [](std::uint32_t, FrameSyntax&) {};
  const Bytes header = WriteSequenceHeader(parts.header), i_frame = WriteIFrame(parts.i_frame, parts.header);
  Bytes stream = Magic();
  const auto start = [&] {
    AppendPacket(stream, PacketType::kHeader, header);
    AppendPacket(stream, PacketType::kIFrame, i_frame);
  };
  start();
  EndSyntax end{0, StreamIndex{static_cast<std::uint32_t>(stream.size()), {}, {}}};
  std::size_t begin = stream.size();
  // In the index a repeated start counts to the group before it.
  const auto group_ends = [&](std::uint32_t frames, bool again) {
    if (again) start();
    end.index->groups.push_back({static_cast<std::uint32_t>(stream.size() - begin), frames});
    begin = stream.size();
    end.frames += frames;
  };
  AppendPacket(stream, PacketType::kGroup, parts.groups[0]);
  group_ends(3, true);
  for (const std::uint32_t frames : {0u, 2u}) {
    const Bytes open = CodeOpenGroup(parts, frames, still, end.frames);
    stream.insert(stream.end(), open.begin(), open.end());
    group_ends(frames, frames == 2);
  }
  AppendPacket(stream, PacketType::kGroup, CodeGroup(parts, 200, 16, still, end.frames));
  group_ends(200, false);
  AppendPacket(stream, PacketType::kEnd, WriteEnd(end));
  return stream;
}

// Layered groups with references to any earlier frame: one with all of its layers, others that lack the last ones.
Bytes Layers() {
  StreamParts parts = SmallStream();
  std::mt19937 random(11);
  Bytes stream = Magic();
  AppendPacket(stream, PacketType::kHeader, WriteSequenceHeader(parts.header));
  AppendPacket(stream, PacketType::kIFrame, WriteIFrame(parts.i_frame, parts.header));
  struct Case {
    std::uint32_t frames, pyramid, base_levels;
    std::size_t layers;
  };
  std::uint32_t first = 0;
  for (const Case& c : {Case{9, 8, 2, 100}, {9, 4, 1, 4}, {9, 8, 1, 3}, {5, 4, 1, 1}, {3, 2, 70, 2}, {1, 1, 1, 100}}) {
    GroupSyntax group{c.frames, first, c.pyramid, 0, c.base_levels};
    const std::vector<Bytes> payloads = CodeLayeredGroup(parts, group, [&](std::uint32_t i, FrameSyntax& frame) {
      FillAtRandom(random, nullptr, i, frame);
      for (PlaneValues& plane : frame.planes) {
        for (std::int32_t& r : plane) r = std::clamp(r, -20, 20);
      }
    });
    for (std::size_t i = 0; i < std::min(c.layers, payloads.size()); ++i) {
      AppendPacket(stream, i == 0 ? PacketType::kGroup : PacketType::kLayer, payloads[i]);
    }
    first += c.frames;
  }
  AppendPacket(stream, PacketType::kEnd, WriteEnd({first, std::nullopt}));
  return stream;
}

// Turns the first frame one way and the next the other.
void Turn(std::uint32_t i, FrameSyntax& frame) { frame.rigid = {0, 0, 2 - 4 * static_cast<int>(i), 1}; }

// The payload of a group of two frames of segment 1.
Bytes SegmentGroup(const StreamParts& parts, std::uint32_t first_frame) {
  const Bytes plain = CodeGroup(parts, 2, 1, Turn, first_frame);
  ByteReader elements(plain);
  for (int i = 0; i < 3; ++i) elements.Varint();
  return WriteGroup({2, first_frame, 1, 1}, std::span(plain).subspan(elements.position()));
}

// An open group of one frame of segment 2, with its records.
Bytes OpenSegmentGroup(const StreamParts& parts, std::uint32_t first_frame) {
  RecordWriter records;
  FrameCoder<RangeEncoder> coder(parts.header, parts.layouts);
  FrameSyntax frame{ChainSlot(0), {}, EmptyPlanes(parts.layouts)};
  Turn(1, frame);
  RangeEncoder range;
  coder.Code(range, ChainSlot(0), frame);
  Bytes out;
  for (const Bytes& part : {records.Open(first_frame, 2), records.Frame(range.Finish()), records.End()}) {
    out.insert(out.end(), part.begin(), part.end());
  }
  return out;
}

// Three segments with other numbers of vertices, one of them in an open group; a start that comes again; packets that
// decoders pass over; an index.
Bytes Segments() {
  const StreamParts first = SmallStream();
  StreamParts second = first, third = first;
  second.i_frame.loose_vertices.push_back({{3, 3, 3}, {}, {}});
  second.i_frame.harmonics.push_back(1);
  second.header.vertices = 5;
  second.header.harmonics = 4;
  Derive(second);
  third.header.detail_step = 0;
  third.header.triangles = 1;
  third.i_frame.loose_triangles.pop_back();
  third.i_frame.harmonics = {2, 1};
  Derive(third);
  Bytes stream = Magic();
  EndSyntax end{6, StreamIndex{}};
  StreamIndex& index = *end.index;
  std::vector<std::size_t> begins;
  const auto start = [&](const StreamParts& parts) {
    const std::size_t before = stream.size();
    AppendPacket(stream, PacketType::kHeader, WriteSequenceHeader(parts.header));
    AppendPacket(stream, PacketType::kIFrame, WriteIFrame(parts.i_frame, parts.header));
    return static_cast<std::uint32_t>(stream.size() - before);
  };
  start(first);
  Metadata metadata;
  metadata.name = "bent square";
  metadata.up_axis = 2;
  AppendPacket(stream, PacketType::kMetadata, WriteMetadata(metadata));
  AppendPacket(stream, static_cast<PacketType>(15), {});
  index.first_group = static_cast<std::uint32_t>(stream.size());
  begins.push_back(stream.size());
  AppendPacket(stream, PacketType::kGroup, first.groups[0]);
  index.segments.push_back({1, start(second)});
  begins.push_back(stream.size());
  AppendPacket(stream, PacketType::kGroup, SegmentGroup(second, 3));
  start(second);  // again
  AppendPacket(stream, PacketType::kSource, {1, 2, 3});
  index.segments.push_back({1, start(third)});
  begins.push_back(stream.size());
  const Bytes open = OpenSegmentGroup(third, 5);
  stream.insert(stream.end(), open.begin(), open.end());
  begins.push_back(stream.size());
  for (std::size_t i = 0; i < 3; ++i) {
    index.groups.push_back({static_cast<std::uint32_t>(begins[i + 1] - begins[i]), static_cast<std::uint32_t>(3 - i)});
  }
  AppendPacket(stream, PacketType::kEnd, WriteEnd(end));
  return stream;
}

// Starts that no group follows, before the first group and between groups of one segment; skippable packets among
// layers; an index.
Bytes UnusedStarts() {
  const StreamParts parts = SmallStream();
  StreamParts other = parts;
  other.header.motion_step *= 2;
  Bytes stream = Magic();
  const auto start = [&](const StreamParts& of) {
    const std::size_t before = stream.size();
    AppendPacket(stream, PacketType::kHeader, WriteSequenceHeader(of.header));
    AppendPacket(stream, PacketType::kIFrame, WriteIFrame(of.i_frame, of.header));
    return static_cast<std::uint32_t>(stream.size() - before);
  };
  start(other);
  start(parts);
  EndSyntax end{8, StreamIndex{static_cast<std::uint32_t>(stream.size()), {}, {}}};
  std::vector<std::size_t> begins = {stream.size()};
  AppendPacket(stream, PacketType::kGroup, parts.groups[0]);
  start(other);
  start(parts);
  begins.push_back(stream.size());
  const auto turn = [](std::uint32_t i, FrameSyntax& frame) { Turn(i % 2, frame); };
  const std::vector<Bytes> layers = CodeLayeredGroup(parts, {3, 3, 2, 0, 1}, turn);
  AppendPacket(stream, PacketType::kGroup, layers[0]);
  AppendPacket(stream, PacketType::kMetadata, {3, 1, 7});  // malformed: readers do without it
  for (std::size_t i = 1; i < layers.size(); ++i) AppendPacket(stream, PacketType::kLayer, layers[i]);
  start(parts);
  end.index->segments.push_back({2, start(other)});
  begins.push_back(stream.size());
  AppendPacket(stream, PacketType::kGroup, SegmentGroup(other, 6));
  begins.push_back(stream.size());
  for (std::size_t i = 0; i < 3; ++i) {
    end.index->groups.push_back({static_cast<std::uint32_t>(begins[i + 1] - begins[i]), i < 2 ? 3u : 2u});
  }
  AppendPacket(stream, PacketType::kEnd, WriteEnd(end));
  return stream;
}

// The stream of appendix A, whose range codes do not end with the fewest bytes.
Bytes LongEnds() {
  const StreamParts parts = SmallStream();
  Bytes stream = Magic(), i_frame = WriteIFrame(parts.i_frame, parts.header), group = parts.groups[0];
  i_frame.push_back(1);
  group.insert(group.end(), {0, 1});
  AppendPacket(stream, PacketType::kHeader, WriteSequenceHeader(parts.header));
  AppendPacket(stream, PacketType::kIFrame, i_frame);
  AppendPacket(stream, PacketType::kGroup, group);
  AppendPacket(stream, PacketType::kEnd, WriteEnd({parts.frames, std::nullopt}));
  return stream;
}

}  // namespace

void AddPacketVectors(std::vector<ValidVector>& vectors) {
  vectors.push_back({"repeated_start", "the start again between groups, an index, an empty group", RepeatedStart()});
  vectors.push_back({"long_ends", "range codes that end later than they have to", LongEnds()});
  vectors.push_back({"layers", "layered groups, whole and without their last layers", Layers()});
  vectors.push_back({"segments", "three meshes, one again, skippable packets, an index of segments", Segments()});
  vectors.push_back(
      {"unused_starts", "starts without groups, packets among layers, malformed metadata", UnusedStarts()});
}

}  // namespace sac

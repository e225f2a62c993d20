// SPDX-License-Identifier: Apache-2.0
#include "conformance/invalid_collection.h"
#include "format/bytes.h"
#include "format/group.h"
#include "format/packet.h"
#include "format/stream_index.h"

namespace sac {
namespace {

using Packets = std::vector<std::pair<PacketType, Bytes>>;

// Adds streams that break the rules of packets and their order.
void AddFraming(Collection& c) {
  const Bytes good = SmallStream().Join();
  Bytes bytes = good;
  bytes[3] = 0x0a;
  c.Add("R1", "magic", bytes);
  bytes = Magic();
  for (int i = 0; i < 5; ++i) bytes.push_back(0xff);
  c.Add("R2", "long_tag", bytes);
  bytes = Magic();
  bytes.insert(bytes.end(), {0x90, 0x00});
  c.Add("R2", "superfluous_zero", bytes);
  ByteWriter huge;
  huge.Bytes(Magic());
  huge.Varint(((1u << 27) + 1) * kPacketTypes);
  c.Add("R3", "payload", huge.bytes(), "limit");
  bytes = good;
  bytes[20] ^= 1;
  c.Add("R4", "flipped_bit", bytes);
  bytes = good;
  bytes.back() ^= 0x80;
  c.Add("R4", "last_crc", bytes);
  c.Add("R5", "empty", {});
  c.Add("R5", "magic_only", Magic());
  c.Add("R5", "last_byte", {good.begin(), good.end() - 1});
  c.ChangePackets("R5", "no_end", [](Packets& p) { p.pop_back(); });
  c.ChangePackets("R6", "two_headers", [](Packets& p) { p.insert(p.begin() + 1, p[0]); });
  c.ChangePackets("R6", "no_i_frame", [](Packets& p) { p.insert(p.begin() + 2, p[0]); });
  c.ChangePackets("R7", "no_header", [](Packets& p) { p.erase(p.begin()); });
  c.ChangePackets("R7", "alone", [](Packets& p) { p.insert(p.begin() + 3, p[1]); });
  c.ChangePackets("R6", "metadata", [](Packets& p) { p.insert(p.begin() + 1, {PacketType::kMetadata, {}}); });
  for (const std::uint8_t type : {5, 6, 7}) {
    Bytes reserved = SmallStream().Join();
    reserved.resize(reserved.size() - PacketSize(1));  // the end packet
    AppendPacket(reserved, static_cast<PacketType>(type), {});
    c.Add("R69", ("type_" + std::to_string(type)).c_str(), reserved, "unsupported");
  }
  c.ChangePackets("R70", "metadata", [](Packets& p) { p.insert(p.begin(), {PacketType::kMetadata, {}}); });
  c.ChangePackets("R70", "i_frame", [](Packets& p) { std::swap(p[0], p[1]); });
  const auto again = [&](const char* rule, const char* name, const std::function<void(SequenceHeader&)>& change) {
    c.ChangePackets(rule, name, [&](Packets& p) {
      SequenceHeader header = SmallStream().header;
      change(header);
      p.insert(p.begin() + 3, {{PacketType::kHeader, WriteSequenceHeader(header)}, p[1]});
    });
  };
  again("R71", "frame_rate", [](SequenceHeader& h) { ++h.frame_rate_numerator; });
  again("R71", "offset", [](SequenceHeader& h) { h.offset_y = 1; });
  again("R12", "later_start", [](SequenceHeader& h) { h.offset_y = h.frame_rate_denominator = 0; });
  c.ChangePackets("R8", "group_first", [](Packets& p) { std::swap(p[1], p[2]); });
  c.ChangePackets("R9", "end_first", [](Packets& p) { p = {p[0], {PacketType::kEnd, {0}}}; });
  bytes = good;
  bytes.push_back(0);
  c.Add("R10", "byte", bytes);
  c.ChangePackets("R10", "group", [](Packets& p) { p.push_back(p[2]); });
  c.ChangePackets("R58", "long", [](Packets& p) { p[3].second.push_back(0); });
}

// Adds streams that break the rules of the end packet and its index.
void AddEnd(Collection& c) {
  const auto index = [&](const char* rule, const char* name, const std::function<void(EndSyntax&)>& change) {
    c.ChangePackets(rule, name, [&](Packets& p) {
      const auto start =
          static_cast<std::uint32_t>(4 + PacketSize(p[0].second.size()) + PacketSize(p[1].second.size()));
      EndSyntax end{3, StreamIndex{start, {}, {{static_cast<std::uint32_t>(PacketSize(p[2].second.size())), 3}}}};
      change(end);
      p[3].second = WriteEnd(end);
    });
  };
  index("R67", "first_group", [](EndSyntax& end) { --end.index->first_group; });
  index("R67", "bytes", [](EndSyntax& end) { ++end.index->groups[0].bytes; });
  index("R67", "too_many", [](EndSyntax& end) { end.index->groups.push_back({0, 0}); });
  index("R67", "none", [](EndSyntax& end) { end.index->groups.clear(); });
  index("R58", "sum", [](EndSyntax& end) { end.index->groups[0].frames = 2; });
  c.ChangePackets("R58", "end_size", [](Packets& p) {
    p[3].second = WriteEnd({3, StreamIndex{4, {}, {{1, 3}}}});
    ++p[3].second[p[3].second.size() - 4];
  });
  index("R58", "segment", [](EndSyntax& end) { end.index->segments = {{0, 1}}; });
  index("R58", "segments", [](EndSyntax& end) { end.index->segments = {{1, 1}}; });
  c.ChangePackets("R58", "empty", [](Packets& p) { p[3].second.clear(); });
  c.ChangePackets("R59", "too_few", [](Packets& p) { p[3].second = {2}; });
  c.ChangePackets("R59", "too_many", [](Packets& p) { p[3].second = {4}; });
}

// Adds streams whose payloads are longer or shorter than their syntax.
void AddPayloads(Collection& c) {
  c.ChangePackets("R12", "long", [](Packets& p) { p[0].second.push_back(0); });
  c.ChangePackets("R12", "short", [](Packets& p) { p[0].second.pop_back(); });
  c.ChangePackets("R12", "empty", [](Packets& p) { p[0].second.clear(); });
  c.ChangePackets("R24", "mesh_size", [](Packets& p) { p[1].second = {5, 'D', 'R'}; });
  c.ChangePackets("R24", "empty", [](Packets& p) { p[1].second.clear(); });
  c.ChangePackets("R30", "long", [](Packets& p) { p[1].second.insert(p[1].second.end(), {0, 0, 0, 0, 1}); });
  c.ChangePackets("R30", "zero", [](Packets& p) { p[1].second.push_back(0); });
  c.ChangePackets("R30", "short", [](Packets& p) { p[1].second.resize(p[1].second.size() - 9); });
  c.ChangePackets("R47", "no_pyramid", [](Packets& p) { p[2].second = {1, 0, 0}; });
  c.ChangePackets("R47", "zero_segment", [](Packets& p) { p[2].second = {1, 0, 6, 0}; });
  c.ChangePackets("R47", "zero_base_levels", [](Packets& p) { p[2].second = {1, 0, 5, 0}; });
  c.ChangePackets("R47", "open_pyramid", [](Packets& p) { p[2].second = {0, 0, 8}; });
  c.ChangePackets("R47", "open_layers", [](Packets& p) { p[2].second = {0, 0, 5, 1}; });
  c.ChangePackets("R47", "open_more", [](Packets& p) { p[2].second = {0, 0, 4, 1}; });
  c.ChangePackets("R47", "empty", [](Packets& p) { p[2].second.clear(); });
  c.ChangePackets("R47", "malformed", [](Packets& p) { p[2].second = {0x81, 0x00, 0, 1}; });
  c.ChangePackets("R66", "too_late", [](Packets& p) { p[2].second[1] = 1; });
  c.ChangePackets("R66", "too_early", [](Packets& p) { p.insert(p.begin() + 3, p[2]); });
  c.ChangePackets("R49", "numbers", [](Packets& p) { p[2].second = WriteGroup({3, 0xfffffffeu, 1}, {}); });
  c.ChangePackets("R56", "long", [](Packets& p) { p[2].second.insert(p[2].second.end(), {0, 0, 0, 0, 1}); });
  c.ChangePackets("R56", "zero", [](Packets& p) { p[2].second.push_back(0); });
  c.ChangePackets("R56", "short", [](Packets& p) { p[2].second.resize(5); });
}

// Adds streams whose segments or layers do not follow each other.
void AddSegmentsAndLayers(Collection& c) {
  c.ChangePackets("R72", "no_start", [](Packets& p) { p[2].second = WriteGroup({1, 0, 1, 1}, {}); });
  c.ChangePackets("R72", "first_again", [](Packets& p) {
    SequenceHeader header = SmallStream().header;
    header.motion_step *= 2;
    p.insert(p.begin() + 3, {{PacketType::kHeader, WriteSequenceHeader(header)}, p[1]});
    p.insert(p.begin() + 5, {PacketType::kGroup, WriteGroup({1, 3, 1}, {})});
  });
  c.Change("R50", "layers", [](StreamParts& p) {
    p.header.reference_shape = 1;
    const std::vector<Bytes> payloads = CodeLayeredGroup(p, {3, 0, 1, 0, 1}, [](std::uint32_t, FrameSyntax&) {});
    p.groups[0] = payloads.front();
  });
  const auto layers = [&](const char* name, const std::function<void(std::vector<Bytes>&)>& change) {
    const StreamParts parts = SmallStream();
    const auto fill = [](std::uint32_t i, FrameSyntax& frame) { frame.planes[kMotion][0] = 1 + static_cast<int>(i); };
    std::vector<Bytes> payloads = CodeLayeredGroup(parts, {3, 3, 2, 0, 1}, fill);
    change(payloads);
    c.ChangePackets("R73", name, [&](Packets& p) {
      std::vector<std::pair<PacketType, Bytes>> packets;
      for (const Bytes& payload : payloads) {
        packets.emplace_back(packets.empty() ? PacketType::kGroup : PacketType::kLayer, payload);
      }
      p.insert(p.begin() + 3, packets.begin(), packets.end());
      p.back().second = {6};
    });
  };
  layers("gap", [](std::vector<Bytes>& b) { b.erase(b.begin() + 1); });
  layers("twice", [](std::vector<Bytes>& b) { b[2] = b[1]; });
  layers("too_many", [](std::vector<Bytes>& b) { b.push_back(WriteLayer({3, 4}, {})); });
  layers("first_frame", [](std::vector<Bytes>& b) { b[1][0] = 0; });
  layers("number", [](std::vector<Bytes>& b) { b[1][1] = 0; });
  layers("short", [](std::vector<Bytes>& b) { b[1].resize(1); });
  c.ChangePackets("R73", "no_layers", [](Packets& p) { p.insert(p.begin() + 3, {PacketType::kLayer, {0, 1}}); });
  c.ChangePackets("R73", "no_group", [](Packets& p) { p.insert(p.begin() + 2, {PacketType::kLayer, {0, 1}}); });
}

}  // namespace

void AddPackets(Collection& c) {
  AddSegmentsAndLayers(c);
  AddFraming(c);
  AddEnd(c);
  AddPayloads(c);
}

void AddRecords(Collection& c) {
  // Adds SmallStream() followed by an open group of two frames. `change` gets the bytes of the group's records.
  const auto records = [&](const char* rule, const char* name, const std::function<void(Bytes&)>& change,
                           const char* status = "corrupt", bool cut = false) {
    StreamParts parts = SmallStream();
    const auto fill = [](std::uint32_t i, FrameSyntax& frame) { frame.planes[kMotion][0] = 1 + static_cast<int>(i); };
    Bytes group = CodeOpenGroup(parts, 2, fill, 3);
    const std::size_t packet = PacketSize(3);  // without its records
    Bytes after;
    for (std::size_t i = packet; i < group.size(); ++i) after.push_back(group[i]);
    group.resize(packet);
    change(after);
    group.insert(group.end(), after.begin(), after.end());
    parts.open_groups = {group};
    parts.frames += 2;
    Bytes stream = parts.Join();
    if (cut) stream.resize(stream.size() - 6);  // the end packet
    c.Add(rule, name, std::move(stream), status);
  };
  records(
      "R5", "open_group", [](Bytes& b) { b.resize(b.size() - 5); }, "corrupt", true);
  records(
      "R5", "frame", [](Bytes& b) { b.resize(3); }, "corrupt", true);
  records("R64", "long", [](Bytes& b) { b = {0xff, 0xff, 0xff, 0xff, 0xff}; });
  records("R64", "superfluous_zero", [](Bytes& b) { b = {0x80, 0x00}; });
  records("R65", "frame", [](Bytes& b) { b[1] ^= 4; });
  records("R65", "check", [](Bytes& b) { b[b[0]] ^= 0x80; });
  records("R65", "end", [](Bytes& b) { b.back() ^= 1; });
  records(
      "R3", "frame",
      [](Bytes& b) {
        ByteWriter huge;
        huge.Varint((1u << 28) + 2);
        b = huge.bytes();
      },
      "limit");
  // These records are malformed although their CRC-32 is right.
  const auto frame = [&](const char* rule, const char* name, const Bytes& code) {
    StreamParts parts = SmallStream();
    RecordWriter writer;
    Bytes& group = parts.open_groups.emplace_back(writer.Open(3));
    for (const Bytes& part : {writer.Frame(code), writer.End()}) group.insert(group.end(), part.begin(), part.end());
    parts.frames += 1;
    c.Add(rule, name, parts.Join());
  };
  frame("R56", "record_long", Bytes(100, 0xfe));
}

}  // namespace sac

#include "conformance/invalid_vectors.h"

#include <draco/compression/expert_encode.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "codec/draco_mesh.h"
#include "codec/encode/position_search.h"
#include "format/bytes.h"
#include "format/group_syntax.h"
#include "format/packet.h"
#include "format/stream_index.h"

namespace sac {
namespace {

using Attribute = draco::GeometryAttribute;

template <class Value>
void AddAttribute(draco::Mesh& mesh, Attribute::Type type, draco::DataType data_type,
                  const std::vector<Value>& values) {
  Attribute attribute;
  attribute.Init(type, nullptr, static_cast<std::int8_t>(std::tuple_size_v<Value>), data_type, false, sizeof(Value), 0);
  const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(values.size()));
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), values[i].data());
  }
}

// An octahedron as Draco codes it. `add` adds attributes to six points.
Bytes DracoOctahedron(const std::function<void(draco::Mesh&)>& add, bool integer_positions = true,
                      bool edgebreaker = true) {
  const std::vector<Triangle> triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                           {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  draco::Mesh mesh;
  mesh.set_num_points(6);
  for (const Triangle& t : triangles) {
    mesh.AddFace({draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])});
  }
  const std::vector<std::array<std::int32_t, 3>> positions = {{0, 8, 8},  {15, 8, 8}, {8, 0, 8},
                                                              {8, 14, 8}, {8, 8, 1},  {8, 8, 15}};
  if (integer_positions) {
    AddAttribute(mesh, Attribute::POSITION, draco::DT_INT32, positions);
  } else {
    std::vector<std::array<float, 3>> floats;
    floats.reserve(positions.size());
    for (const auto& p : positions) floats.push_back({1.0f * p[0], 1.0f * p[1], 1.0f * p[2]});
    AddAttribute(mesh, Attribute::POSITION, draco::DT_FLOAT32, floats);
  }
  add(mesh);
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING : draco::MESH_SEQUENTIAL_ENCODING);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeToBuffer(&buffer).ok()) std::abort();
  return {buffer.data(), buffer.data() + buffer.size()};
}

StreamParts Octahedron() {
  StreamParts parts;
  SequenceHeader& h = parts.header;
  h.position_bits = 4;
  h.vertices = 6;
  h.triangles = 8;
  h.harmonics = 4;
  h.motion_step = h.displacement_step = h.rotation_step = h.translation_step = 0.01f;
  parts.i_frame.mesh = DracoOctahedron([](draco::Mesh&) {});
  parts.i_frame.harmonics = {4};
  DracoMesh draco;
  if (!DecodeDraco(parts.i_frame.mesh, h, draco).ok()) std::abort();
  const std::vector<std::array<double, 3>> cells = {{0, 8, 8},  {8, 0, 8},  {8, 8, 1},
                                                    {15, 8, 8}, {8, 14, 8}, {8, 8, 15}};
  parts.i_frame.positions = EncodePositions(cells, PositionGraph(6, draco.triangles), {16, 0}, h.position_bits);
  Derive(parts);
  parts.frames = 1;
  parts.groups = {CodeGroup(parts, 1, 1, [](std::uint32_t, FrameSyntax& frame) { frame.planes[kMotion][9] = 5; })};
  return parts;
}

class Collection {
 public:
  void Add(const char* rule, const char* name, Bytes stream, const char* status = "corrupt") {
    vectors.push_back({rule, name, status, std::move(stream)});
  }
  // The small stream with its parts changed.
  void Change(const char* rule, const char* name, const std::function<void(StreamParts&)>& change,
              const char* status = "corrupt") {
    StreamParts parts = SmallStream();
    change(parts);
    Add(rule, name, parts.Join(), status);
  }
  // Likewise of a stream with a Draco mesh.
  void ChangeDraco(const char* rule, const char* name, const std::function<void(StreamParts&)>& change) {
    StreamParts parts = Octahedron();
    change(parts);
    Add(rule, name, parts.Join());
  }
  // The small stream with packets of one type changed: payloads, or the packets' order and number.
  void ChangePackets(const char* rule, const char* name,
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
  void ChangeGroup(const char* rule, const char* name, std::uint32_t frames, std::uint32_t pyramid,
                   const std::function<void(std::uint32_t, FrameSyntax&)>& fill, std::uint8_t reference_shape = 0,
                   const char* status = "corrupt") {
    Change(
        rule, name,
        [&](StreamParts& p) {
          p.header.reference_shape = reference_shape;
          p.groups = {CodeGroup(p, frames, pyramid, fill)};
          p.frames = frames;
        },
        status);
  }

  std::vector<InvalidVector> vectors;
};

void AddPackets(Collection& c) {
  using Packets = std::vector<std::pair<PacketType, Bytes>>;
  const Bytes good = SmallStream().Join();
  Bytes bytes = good;
  bytes[3] = 0x0a;
  c.Add("R1", "magic", bytes);
  bytes = Magic();
  for (int i = 0; i < 5; ++i) bytes.push_back(0xff);
  c.Add("R2", "long_tag", bytes);
  bytes = Magic();
  bytes.insert(bytes.end(), {0x84, 0x00});
  c.Add("R2", "superfluous_zero", bytes);
  ByteWriter huge;
  huge.Bytes(Magic());
  huge.Varint(((1u << 28) + 1) * 4);
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
  c.ChangePackets("R6", "another", [](Packets& p) {
    p.insert(p.begin() + 3, {p[0], p[1]});
    p[3].second.back() ^= 1;
  });
  c.ChangePackets("R7", "no_header", [](Packets& p) { p.erase(p.begin()); });
  c.ChangePackets("R7", "alone", [](Packets& p) { p.insert(p.begin() + 3, p[1]); });
  c.ChangePackets("R7", "another", [](Packets& p) {
    p.insert(p.begin() + 3, {p[0], p[1]});
    p[4].second.push_back(0);
  });
  c.ChangePackets("R8", "group_first", [](Packets& p) { std::swap(p[1], p[2]); });
  c.ChangePackets("R9", "end_first", [](Packets& p) { p = {p[0], {PacketType::kEnd, {0}}}; });
  bytes = good;
  bytes.push_back(0);
  c.Add("R10", "byte", bytes);
  c.ChangePackets("R10", "group", [](Packets& p) { p.push_back(p[2]); });
  c.ChangePackets("R58", "long", [](Packets& p) { p[3].second.push_back(0); });
  const auto index = [&](const char* rule, const char* name, const std::function<void(EndSyntax&)>& change) {
    c.ChangePackets(rule, name, [&](Packets& p) {
      const auto start =
          static_cast<std::uint32_t>(4 + PacketSize(p[0].second.size()) + PacketSize(p[1].second.size()));
      EndSyntax end{3, StreamIndex{start, {{static_cast<std::uint32_t>(PacketSize(p[2].second.size())), 3}}}};
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
    p[3].second = WriteEnd({3, StreamIndex{4, {{1, 3}}}});
    ++p[3].second[p[3].second.size() - 4];
  });
  c.ChangePackets("R58", "empty", [](Packets& p) { p[3].second.clear(); });
  c.ChangePackets("R59", "too_few", [](Packets& p) { p[3].second = {2}; });
  c.ChangePackets("R59", "too_many", [](Packets& p) { p[3].second = {4}; });
  c.ChangePackets("R12", "long", [](Packets& p) { p[0].second.push_back(0); });
  c.ChangePackets("R12", "short", [](Packets& p) { p[0].second.pop_back(); });
  c.ChangePackets("R12", "empty", [](Packets& p) { p[0].second.clear(); });
  c.ChangePackets("R24", "mesh_size", [](Packets& p) { p[1].second = {5, 'D', 'R'}; });
  c.ChangePackets("R24", "empty", [](Packets& p) { p[1].second.clear(); });
  c.ChangePackets("R30", "long", [](Packets& p) { p[1].second.insert(p[1].second.end(), {0, 0, 0, 0, 1}); });
  c.ChangePackets("R30", "zero", [](Packets& p) { p[1].second.push_back(0); });
  c.ChangePackets("R30", "other_end", [](Packets& p) { p[1].second.push_back(1); });
  c.ChangePackets("R30", "short", [](Packets& p) { p[1].second.resize(p[1].second.size() - 9); });
  c.ChangePackets("R47", "no_frames", [](Packets& p) { p[2].second = {0, 0, 1}; });
  c.ChangePackets("R47", "no_pyramid", [](Packets& p) { p[2].second = {1, 0, 0}; });
  c.ChangePackets("R47", "empty", [](Packets& p) { p[2].second.clear(); });
  c.ChangePackets("R47", "malformed", [](Packets& p) { p[2].second = {0x81, 0x00, 0, 1}; });
  c.ChangePackets("R66", "too_late", [](Packets& p) { p[2].second[1] = 1; });
  c.ChangePackets("R66", "too_early", [](Packets& p) { p.insert(p.begin() + 3, p[2]); });
  c.ChangePackets("R49", "numbers", [](Packets& p) { p[2].second = WriteGroup({3, 0xfffffffeu, 1}, {}); });
  c.ChangePackets("R56", "long", [](Packets& p) { p[2].second.insert(p[2].second.end(), {0, 0, 0, 0, 1}); });
  c.ChangePackets("R56", "zero", [](Packets& p) { p[2].second.push_back(0); });
  c.ChangePackets("R56", "other_end", [](Packets& p) { p[2].second.push_back(1); });
  c.ChangePackets("R56", "short", [](Packets& p) { p[2].second.resize(5); });
}

void AddRecords(Collection& c) {
  // The small stream's second half: an open group of two frames. `change` is given its records after the packet.
  const auto records = [&](const char* rule, const char* name, const std::function<void(Bytes&)>& change,
                           const char* status = "corrupt", bool cut = false) {
    StreamParts parts = SmallStream();
    const auto fill = [](std::uint32_t i, FrameSyntax& frame) { frame.planes[kMotion][0] = 1 + static_cast<int>(i); };
    Bytes group = CodeOpenGroup(parts, 2, fill, 3);
    Bytes after(group.begin() + 7, group.end());
    group.resize(7);
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
  // Frames whose checks are right.
  const auto frame = [&](const char* rule, const char* name, const Bytes& code) {
    StreamParts parts = SmallStream();
    RecordWriter writer;
    Bytes& group = parts.open_groups.emplace_back(writer.Open(3));
    for (const Bytes& part : {writer.Frame(code), writer.End()}) group.insert(group.end(), part.begin(), part.end());
    parts.frames += 1;
    c.Add(rule, name, parts.Join());
  };
  frame("R56", "record_long", {0xfe, 0xfe, 0xfe, 0xfe, 0xfe, 0xfe, 0xfe, 0xfe, 0xfe, 0xfe, 0xfe, 0xfe, 0xfe, 0xfe});
}

void AddHeader(Collection& c) {
  const auto header = [&](const char* rule, const char* name, const std::function<void(SequenceHeader&)>& change,
                          const char* status = "corrupt") {
    c.Change(
        rule, name, [&](StreamParts& p) { change(p.header); }, status);
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  header(
      "R11", "major", [](SequenceHeader& h) { h.version_major = 200; }, "unsupported");
  header(
      "R11", "minor", [](SequenceHeader& h) { h.version_minor = 200; }, "unsupported");
  header("R13", "reference_shape", [](SequenceHeader& h) { h.reference_shape = 2; });
  header("R14", "none", [](SequenceHeader& h) { h.position_bits = 0; });
  header("R14", "many", [](SequenceHeader& h) { h.position_bits = 25; });
  header("R15", "small", [](SequenceHeader& h) { h.level_growth = 63; });
  header("R15", "large", [](SequenceHeader& h) { h.level_growth = 129; });
  header("R16", "vertices", [](SequenceHeader& h) { h.vertices = h.harmonics = 0; });
  header("R17", "harmonics", [](SequenceHeader& h) { h.harmonics = 0; });
  header("R18", "harmonics", [](SequenceHeader& h) { h.harmonics = 5; });
  header("R19", "denominator", [](SequenceHeader& h) { h.frame_rate_denominator = 0; });
  header("R20", "nan", [](SequenceHeader& h) { h.origin_x = kNan; });
  header("R20", "infinity", [](SequenceHeader& h) { h.origin_z = -kInfinity; });
  header("R21", "cell", [](SequenceHeader& h) { h.cell = 0; });
  header("R21", "motion", [](SequenceHeader& h) { h.motion_step = -1; });
  header("R21", "displacement", [](SequenceHeader& h) { h.displacement_step = kInfinity; });
  header("R21", "rotation", [](SequenceHeader& h) { h.rotation_step = kNan; });
  header("R21", "translation", [](SequenceHeader& h) { h.translation_step = 0; });
  header("R61", "none", [](SequenceHeader& h) { h.patch_size = 0; });
  header("R61", "many", [](SequenceHeader& h) { h.patch_size = 1025; });
  header("R62", "detail", [](SequenceHeader& h) { h.detail_step = -1; });
  header("R62", "correction", [](SequenceHeader& h) { h.correction_step = kNan; });
  header(
      "R22", "vertices", [](SequenceHeader& h) { h.vertices = 4'000'001; }, "limit");
  header(
      "R23", "triangles", [](SequenceHeader& h) { h.triangles = 8'000'001; }, "limit");
}

void AddSideInformation(Collection& c) {
  const auto i_frame = [&](const char* rule, const char* name, const std::function<void(IFrameSyntax&)>& change,
                           const char* status = "corrupt") {
    c.Change(
        rule, name, [&](StreamParts& p) { change(p.i_frame); }, status);
  };
  i_frame("R25", "count", [](IFrameSyntax& s) {
    for (std::uint32_t i = 1; i <= 7; ++i) s.welds.push_back({i, 0});
  });
  i_frame("R25", "point", [](IFrameSyntax& s) { s.welds = {{6, 0}}; });
  i_frame("R25", "onto", [](IFrameSyntax& s) { s.welds = {{2, 0xffffffffu}}; });  // a distance of 2
  i_frame("R26", "count", [](IFrameSyntax& s) { s.loose_vertices.push_back(s.loose_vertices[0]); });
  i_frame("R26", "above", [](IFrameSyntax& s) { s.loose_vertices[3].position[1] = 16; });
  i_frame("R26", "below", [](IFrameSyntax& s) { s.loose_vertices[0].position[2] = 0xffffffffu; });
  i_frame("R27", "count", [](IFrameSyntax& s) { s.loose_triangles.push_back(s.loose_triangles[0]); });
  i_frame("R27", "above", [](IFrameSyntax& s) { s.loose_triangles[1][2] = 4; });
  i_frame("R27", "below", [](IFrameSyntax& s) { s.loose_triangles[0][0] = 0xffffffffu; });
  i_frame("R28", "none", [](IFrameSyntax& s) { s.harmonics = {0}; });
  i_frame("R28", "too_few", [](IFrameSyntax& s) { s.harmonics = {2}; });
  i_frame("R28", "too_many", [](IFrameSyntax& s) { s.harmonics = {3, 1}; });
  i_frame("R28", "no_component", [](IFrameSyntax& s) { s.harmonics.clear(); });
  i_frame("R29", "twice", [](IFrameSyntax& s) { s.order = {3, 2, 1, 1}; });
  i_frame("R29", "missing", [](IFrameSyntax& s) { s.order = {0, 1, 2, 4}; });
  c.Change("R40", "vertices", [](StreamParts& p) { ++p.header.vertices; });
  c.Change("R41", "triangles", [](StreamParts& p) { ++p.header.triangles; });
  i_frame("R42", "components", [](IFrameSyntax& s) { s.harmonics = {2, 1}; });
  c.Change("R43", "harmonics", [](StreamParts& p) {  // a component of one vertex, one of three
    p.i_frame.loose_triangles = {{1, 2, 3}, {1, 2, 3}};
    p.i_frame.harmonics = {2, 1};
  });
  c.Change(
      "R44", "harmonics",
      [](StreamParts& p) {  // a strip of 8,194 vertices at one position
        p.header.vertices = 8194;
        p.header.triangles = 4097;
        p.header.harmonics = 8193;
        p.i_frame.loose_vertices.assign(8194, p.i_frame.loose_vertices[0]);
        p.i_frame.loose_triangles.clear();
        for (std::uint32_t v = 0; v < 8192; v += 2) p.i_frame.loose_triangles.push_back({v, v + 1, v + 2});
        p.i_frame.loose_triangles.push_back({8191, 8192, 8193});
        p.i_frame.harmonics = {8193};
        p.groups.clear();
      },
      "limit");
  c.Change(
      "R44", "patches",
      [](StreamParts& p) {  // so many vertices that their patches could be too much, each a component
        p.header.vertices = p.header.harmonics = 262145;
        p.header.triangles = 0;
        p.header.patch_size = 1024;
        p.i_frame.loose_vertices.assign(262145, p.i_frame.loose_vertices[0]);
        p.i_frame.loose_triangles.clear();
        p.i_frame.harmonics.assign(262145, 1);
        p.groups.clear();
      },
      "limit");
  c.Change("R45", "path", [](StreamParts& p) {  // a path, at one position: eigenvalues all but equal
    constexpr std::uint32_t kVertices = 300;
    p.header.vertices = kVertices;
    p.header.triangles = kVertices - 1;
    p.header.harmonics = 2;
    p.header.detail_step = p.header.correction_step = 0;
    p.i_frame.loose_vertices.assign(kVertices, p.i_frame.loose_vertices[0]);
    p.i_frame.loose_triangles.clear();
    for (std::uint32_t v = 0; v + 1 < kVertices; ++v) p.i_frame.loose_triangles.push_back({v, v + 1, v + 1});
    p.i_frame.harmonics = {2};
    p.groups.clear();
  });
  i_frame(
      "R46", "eigenvalues", [](IFrameSyntax& s) { s.fingerprint[0] *= 1.001f; }, "unsupported");
  i_frame(
      "R46", "vectors", [](IFrameSyntax& s) { s.fingerprint[1] += 0.001f; }, "unsupported");
  c.Change(
      "R46", "patches",
      [](StreamParts& p) {  // the fingerprint of the components alone
        const float detail_step = std::exchange(p.header.detail_step, 0.0f);
        Derive(p);
        p.header.detail_step = detail_step;
      },
      "unsupported");
  i_frame(
      "R46", "nan", [](IFrameSyntax& s) { s.fingerprint[1] = std::nanf(""); }, "unsupported");
}

void AddDraco(Collection& c) {
  const auto mesh = [&](const char* rule, const char* name, const Bytes& bytes) {
    c.ChangeDraco(rule, name, [&](StreamParts& p) { p.i_frame.mesh = bytes; });
  };
  const auto byte = [&](const char* rule, const char* name, std::size_t at, std::uint8_t value) {
    c.ChangeDraco(rule, name, [&](StreamParts& p) { p.i_frame.mesh[at] = value; });
  };
  const auto plain = [](draco::Mesh&) {};
  byte("R31", "name", 4, 'A');
  byte("R31", "version", 6, 1);
  byte("R31", "point_cloud", 7, 0);
  mesh("R31", "sequential", DracoOctahedron(plain, true, false));
  byte("R31", "flags", 10, 0x80);
  c.ChangeDraco("R32", "triangles", [](StreamParts& p) { p.header.triangles = 7; });
  byte("R32", "attributes", 14, 4);
  byte("R32", "vertices", 12, 25);
  c.ChangeDraco("R32", "short", [](StreamParts& p) { p.i_frame.mesh.resize(12); });
  c.ChangeDraco("R33", "truncated", [](StreamParts& p) { p.i_frame.mesh.resize(p.i_frame.mesh.size() - 4); });
  c.ChangeDraco("R33", "trailing", [](StreamParts& p) { p.i_frame.mesh.push_back(0); });
  mesh("R34", "float_positions", DracoOctahedron(plain, false));
  c.ChangeDraco("R35", "off_the_grid", [](StreamParts& p) { p.i_frame.position_step = 16 * 9; });
  mesh("R36", "generic", DracoOctahedron([](draco::Mesh& m) {
         AddAttribute(m, Attribute::GENERIC, draco::DT_UINT32, std::vector<std::array<std::uint32_t, 1>>(6, {7}));
       }));
  mesh("R36", "texture_coordinates", DracoOctahedron([](draco::Mesh& m) {
         AddAttribute(m, Attribute::TEX_COORD, draco::DT_FLOAT32, std::vector<std::array<float, 3>>(6, {1, 2, 3}));
       }));
  mesh("R36", "normals", DracoOctahedron([](draco::Mesh& m) {
         AddAttribute(m, Attribute::NORMAL, draco::DT_INT32, std::vector<std::array<std::int32_t, 3>>(6, {0, 0, 1}));
       }));
  mesh("R36", "colors", DracoOctahedron([](draco::Mesh& m) {
         AddAttribute(m, Attribute::COLOR, draco::DT_UINT8, std::vector<std::array<std::uint8_t, 3>>(6, {1, 2, 3}));
       }));
  c.ChangeDraco("R37", "point", [](StreamParts& p) { p.i_frame.welds = {{6, 0}}; });
  c.ChangeDraco("R38", "positions",
                [](StreamParts& p) { p.i_frame.positions.insert(p.i_frame.positions.end(), 5, 1); });
  c.ChangeDraco("R38", "zero", [](StreamParts& p) { p.i_frame.positions.push_back(0); });
  c.ChangeDraco("R38", "short", [](StreamParts& p) { p.i_frame.positions.clear(); });
  const auto loose = [&](const char* name, const Bytes& bytes) {
    c.ChangeDraco("R39", name, [&](StreamParts& p) {
      p.i_frame.mesh = bytes;
      p.header.vertices = 7;
      p.header.harmonics = 5;
      p.i_frame.loose_vertices.push_back({{1, 1, 1}, {}, {}});
      p.i_frame.harmonics = {4, 1};
      p.groups.clear();
    });
  };
  loose("normals", DracoOctahedron([](draco::Mesh& m) {
          AddAttribute(m, Attribute::NORMAL, draco::DT_FLOAT32, std::vector<std::array<float, 3>>(6, {0, 0, 1}));
        }));
  loose("colors", DracoOctahedron([](draco::Mesh& m) {
          AddAttribute(m, Attribute::COLOR, draco::DT_UINT8, std::vector<std::array<std::uint8_t, 4>>(6, {1, 2, 3, 4}));
        }));
}

void AddGroups(Collection& c) {
  const auto nothing = [](std::uint32_t, FrameSyntax&) {};
  c.ChangeGroup("R48", "frames", 4097, 1, nothing, 0, "limit");
  c.Change(
      "R63", "coefficients",
      [](StreamParts& p) {  // 4,096 frames of 2,731 vertices, each a component with its harmonic
        p.header.vertices = p.header.harmonics = 2731;
        p.header.triangles = 0;
        p.header.detail_step = p.header.correction_step = 0;
        p.i_frame.loose_vertices.assign(2731, p.i_frame.loose_vertices[0]);
        p.i_frame.loose_triangles.clear();
        p.i_frame.harmonics.assign(2731, 1);
        Derive(p);
        p.groups = {CodeGroup(p, 4096, 1, [](std::uint32_t, FrameSyntax&) {})};
        p.frames = 4096;
      },
      "limit");
  c.ChangeGroup("R50", "pyramid", 3, 2, nothing, 1);
  c.ChangeGroup("R51", "distance", 3, 1, [](std::uint32_t i, FrameSyntax& f) {
    if (i == 2) f.slot.references = {0xffffffffu};  // a distance of 2
  });
  c.ChangeGroup("R51", "far", 3, 1, [](std::uint32_t i, FrameSyntax& f) {
    if (i == 2) f.slot.references = {1, 0u - 1000u};
  });
  c.ChangeGroup("R52", "motion", 1, 1, [](std::uint32_t, FrameSyntax& f) { f.planes[kMotion][5] = (1 << 20) + 1; });
  c.ChangeGroup("R52", "displacement", 1, 1,
                [](std::uint32_t, FrameSyntax& f) { f.planes[kDisplacement][8] = -(1 << 20) - 1; });
  c.ChangeGroup("R52", "detail", 1, 1, [](std::uint32_t, FrameSyntax& f) { f.planes[kDetail][0] = 1 << 21; });
  c.ChangeGroup("R52", "correction", 1, 1,
                [](std::uint32_t, FrameSyntax& f) { f.planes[kCorrection][0] = -(1 << 21); });
  c.ChangeGroup("R53", "rotation", 1, 1, [](std::uint32_t, FrameSyntax& f) { f.rigid[1] = (1 << 28) + 1; });
  c.ChangeGroup("R53", "translation", 1, 1, [](std::uint32_t, FrameSyntax& f) { f.rigid[5] = -(1 << 30); });
  c.ChangeGroup(
      "R54", "two", 3, 1,
      [](std::uint32_t i, FrameSyntax& f) {
        if (i == 2) f.slot.references = {1, 1};
      },
      1);
  c.ChangeGroup(
      "R54", "earlier", 3, 1,
      [](std::uint32_t i, FrameSyntax& f) {
        if (i == 2) f.slot.references = {0};
      },
      1);
  c.ChangeGroup("R55", "motion", 17, 1, [](std::uint32_t, FrameSyntax& f) { f.planes[kMotion][0] = 1 << 20; });
  c.Change("R57", "position", [](StreamParts& p) {
    p.header.translation_step = 1e38f;
    p.groups = {CodeGroup(p, 1, 1, [](std::uint32_t, FrameSyntax& f) { f.rigid[3] = 4; })};
    p.frames = 1;
  });
  c.ChangeGroup("R55", "rigid", 2, 1, [](std::uint32_t, FrameSyntax& f) { f.rigid[0] = -(1 << 27) - 1; });
}

}  // namespace

std::vector<InvalidVector> InvalidVectors() {
  Collection c;
  AddPackets(c);
  AddRecords(c);
  AddHeader(c);
  AddSideInformation(c);
  AddDraco(c);
  AddGroups(c);
  return std::move(c.vectors);
}

}  // namespace sac

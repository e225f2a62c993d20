// SPDX-License-Identifier: Apache-2.0
#include <draco/compression/expert_encode.h>

#include <cstdlib>
#include <utility>

#include "codec/draco_mesh.h"
#include "codec/encode/position_search.h"
#include "conformance/invalid_collection.h"

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

// An octahedron coded by Draco. `add` adds attributes to the mesh, which has six points.
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

}  // namespace

void AddDraco(Collection& c) {
  const auto change_draco = [&](const char* rule, const char* name, const std::function<void(StreamParts&)>& change) {
    StreamParts parts = Octahedron();
    change(parts);
    c.Add(rule, name, parts.Join());
  };
  const auto mesh = [&](const char* rule, const char* name, const Bytes& bytes) {
    change_draco(rule, name, [&](StreamParts& p) { p.i_frame.mesh = bytes; });
  };
  const auto byte = [&](const char* rule, const char* name, std::size_t at, std::uint8_t value) {
    change_draco(rule, name, [&](StreamParts& p) { p.i_frame.mesh[at] = value; });
  };
  const auto plain = [](draco::Mesh&) {};
  byte("R31", "name", 4, 'A');
  byte("R31", "version", 6, 1);
  byte("R31", "point_cloud", 7, 0);
  mesh("R31", "sequential", DracoOctahedron(plain, true, false));
  byte("R31", "flags", 10, 0x80);
  change_draco("R32", "triangles", [](StreamParts& p) { p.header.triangles = 7; });
  byte("R32", "attributes", 14, 4);
  byte("R32", "vertices", 12, 25);
  change_draco("R32", "short", [](StreamParts& p) { p.i_frame.mesh.resize(12); });
  change_draco("R33", "truncated", [](StreamParts& p) { p.i_frame.mesh.resize(p.i_frame.mesh.size() - 4); });
  change_draco("R33", "trailing", [](StreamParts& p) { p.i_frame.mesh.push_back(0); });
  mesh("R34", "float_positions", DracoOctahedron(plain, false));
  change_draco("R35", "off_the_grid", [](StreamParts& p) { p.i_frame.position_step = 16 * 9; });
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
  change_draco("R37", "point", [](StreamParts& p) { p.i_frame.welds = {{6, 0}}; });
  change_draco("R30", "positions_long", [](StreamParts& p) {
    for (std::uint32_t more : {1u, 2u, 3u}) p.i_frame.positions.Raw(more, 32);
  });
  change_draco("R30", "positions_short", [](StreamParts& p) { p.i_frame.positions = {}; });
  const auto loose = [&](const char* name, const Bytes& bytes) {
    change_draco("R39", name, [&](StreamParts& p) {
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

}  // namespace sac

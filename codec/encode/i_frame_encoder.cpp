// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/i_frame_encoder.h"

#include <draco/compression/expert_encode.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "codec/encode/coded_normals.h"
#include "codec/encode/position_search.h"

namespace sac {
namespace {

constexpr int kUvBits = 12;
constexpr std::uint32_t kNoEntry = 0xffffffffu;

// The part of a mesh that Draco is given: triangles with three different vertices, and the vertices they use.
struct DracoInput {
  std::vector<std::uint32_t> vertices;               // input vertex per entry
  std::vector<Triangle> triangles;                   // of points
  std::vector<std::array<std::uint32_t, 3>> points;  // entry, texture coordinate and corner's normal
};

DracoInput SelectForDraco(const Mesh& input, const CodedNormals& normals) {
  DracoInput out;
  std::vector<std::uint32_t> entry(input.positions.size(), kNoEntry);
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> point_of;
  for (std::size_t j = 0; j < input.triangles.size(); ++j) {
    const Triangle& t = input.triangles[j];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    Triangle& points = out.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      if (entry[t[k]] == kNoEntry) {
        entry[t[k]] = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(t[k]);
      }
      const std::array<std::uint32_t, 3> key = {entry[t[k]], input.uv_triangles.empty() ? 0 : input.uv_triangles[j][k],
                                                normals.triangles.empty() ? 0 : normals.triangles[j][k]};
      const auto [at, is_new] = point_of.try_emplace(key, static_cast<std::uint32_t>(out.points.size()));
      if (is_new) out.points.push_back(key);
      points[k] = at->second;
    }
  }
  return out;
}

// Adds an attribute whose values are per entry (`index` 0), per texture coordinate (1) or per normal of corners (2).
template <class Value>
int AddAttribute(draco::Mesh& mesh, const DracoInput& input, draco::GeometryAttribute::Type type,
                 draco::DataType data_type, bool normalized, std::size_t index, const std::vector<Value>& values) {
  constexpr auto kComponents = static_cast<std::int8_t>(std::tuple_size_v<Value>);
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, kComponents, data_type, normalized, sizeof(Value), 0);
  const int id = mesh.AddAttribute(attribute, false, static_cast<std::uint32_t>(values.size()));
  draco::PointAttribute* out = mesh.attribute(id);
  out->SetExplicitMapping(input.points.size());
  for (std::uint32_t p = 0; p < input.points.size(); ++p) {
    out->SetPointMapEntry(draco::PointIndex(p), draco::AttributeValueIndex(input.points[p][index]));
  }
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    out->SetAttributeValue(draco::AttributeValueIndex(i), values[i].data());
  }
  return id;
}

template <class Value>
std::vector<Value> Gather(const std::vector<Value>& values, const std::vector<std::uint32_t>& indices) {
  std::vector<Value> out;
  out.reserve(indices.size());
  for (const std::uint32_t i : indices) out.push_back(values[i]);
  return out;
}

// With `with_ids`, each entry also carries its number, to learn how Draco reorders and splits.
Status RunDraco(const Mesh& input, const CodedNormals& normals, const DracoInput& selected, bool with_ids,
                std::vector<std::uint8_t>& bytes) {
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(selected.points.size()));
  mesh.SetNumFaces(selected.triangles.size());
  for (std::uint32_t j = 0; j < selected.triangles.size(); ++j) {
    const Triangle& t = selected.triangles[j];
    mesh.SetFace(draco::FaceIndex(j), {draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])});
  }
  using Attribute = draco::GeometryAttribute;
  // Draco needs positions to tell vertices apart, but not their values.
  AddAttribute(mesh, selected, Attribute::POSITION, draco::DT_INT32, false, 0,
               std::vector<std::array<std::int32_t, 3>>(selected.vertices.size()));
  int uv = -1, normal = -1;
  if (!input.uv_triangles.empty()) {
    uv = AddAttribute(mesh, selected, Attribute::TEX_COORD, draco::DT_FLOAT32, false, 1, input.uvs);
  }
  if (!normals.triangles.empty()) {
    normal = AddAttribute(mesh, selected, Attribute::NORMAL, draco::DT_FLOAT32, false, 2, normals.values);
  } else if (!normals.values.empty()) {
    normal = AddAttribute(mesh, selected, Attribute::NORMAL, draco::DT_FLOAT32, false, 0,
                          Gather(normals.values, selected.vertices));
  }
  if (!input.colors.empty()) {
    AddAttribute(mesh, selected, Attribute::COLOR, draco::DT_UINT8, true, 0, Gather(input.colors, selected.vertices));
  }
  if (with_ids) {
    std::vector<std::array<std::uint32_t, 1>> ids(selected.vertices.size());
    for (std::uint32_t e = 0; e < ids.size(); ++e) ids[e] = {e};
    AddAttribute(mesh, selected, Attribute::GENERIC, draco::DT_UINT32, false, 0, ids);
  }
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetSpeedOptions(0, 0);
  if (uv >= 0) {
    encoder.SetAttributeQuantization(uv, kUvBits);
    (void)encoder.SetAttributePredictionScheme(uv, draco::MESH_PREDICTION_CONSTRAINED_MULTI_PARALLELOGRAM);
  }
  if (normal >= 0) {
    encoder.SetAttributeQuantization(normal, kNormalBits);
    (void)encoder.SetAttributePredictionScheme(normal, draco::PREDICTION_DIFFERENCE);
  }
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) return Status::InvalidArgument("Draco: " + status.error_msg_string());
  bytes.assign(buffer.data(), buffer.data() + buffer.size());
  return Status::Ok();
}

// A triangle with its smallest vertex first, so that turned ones compare equal.
Triangle Canonical(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

// Codes what Draco can take and decodes it again, with the input vertex of each entry as its id. False when Draco fails
// on this mesh: then the whole mesh is coded loose.
bool TryDraco(const Mesh& input, const CodedNormals& normals, const SequenceHeader& header,
              std::vector<std::uint8_t>& bytes, DracoMesh& draco) {
  const DracoInput selected = SelectForDraco(input, normals);
  if (selected.triangles.empty()) return false;
  std::vector<std::uint8_t> bytes_with_ids;
  DracoMesh with_ids;
  if (!RunDraco(input, normals, selected, false, bytes).ok() || !DecodeDraco(bytes, header, draco).ok()) return false;
  if (!RunDraco(input, normals, selected, true, bytes_with_ids).ok() ||
      !DecodeDraco(bytes_with_ids, header, with_ids, true).ok()) {
    return false;
  }
  // The ids are of another run; they count only if both agree on everything else.
  if (with_ids.triangles != draco.triangles || with_ids.entries != draco.entries) return false;
  draco.ids = Gather(selected.vertices, with_ids.ids);
  return true;
}

GridPosition Rounded(const std::array<double, 3>& cells, int bits) {
  GridPosition grid;
  for (std::size_t a = 0; a < 3; ++a) {
    grid[a] = static_cast<std::uint32_t>(std::clamp(std::round(cells[a]), 0.0, std::ldexp(1.0, bits) - 1));
  }
  return grid;
}

// Codes the positions of the vertices that Draco's entries are joined to.
void CodePositions(const PositionTargets& targets, const DracoMesh& draco,
                   const std::vector<std::uint32_t>& vertex_of_input, std::uint32_t vertices,
                   const SequenceHeader& header, IFrameSyntax& syntax) {
  std::vector<std::array<double, 3>> cells(vertices);
  for (const std::uint32_t i : draco.ids) cells[vertex_of_input[i]] = targets.cells[i];
  std::vector<Triangle> triangles = draco.triangles;
  for (Triangle& t : triangles) {
    for (std::uint32_t& e : t) e = vertex_of_input[draco.ids[e]];
  }
  syntax.position_step = targets.steps.base;
  syntax.position_slope = targets.steps.slope;
  syntax.positions = EncodePositions(cells, PositionGraph(vertices, triangles), targets.steps, header.position_bits);
}

}  // namespace

Status EncodeIFrameMesh(const Mesh& input, const PositionTargets& targets, const SequenceHeader& header,
                        IFrameSyntax& syntax, DecodedIFrame& decoded, std::vector<std::uint32_t>& input_of_vertex) {
  DracoMesh draco;
  const CodedNormals normals = NormalsToCode(input);
  if (!TryDraco(input, normals, header, syntax.mesh, draco)) {
    syntax.mesh.clear();
    draco = {};
  }
  // Only Draco codes normals of corners; one a vertex would be wrong there.
  syntax.has_normals = !normals.values.empty() && (normals.triangles.empty() || !syntax.mesh.empty());
  syntax.has_colors = !input.colors.empty();

  // Vertices, in the numbering before components are sorted (spec.md 5.3): Draco's, then those it has not.
  std::vector<std::uint32_t> vertex_of_input(input.positions.size(), kNoEntry), first_entry(input.positions.size());
  std::vector<std::uint32_t> input_of_entry = draco.ids;
  std::uint32_t vertices = 0;
  for (std::uint32_t e = 0; e < draco.entries; ++e) {
    const std::uint32_t i = draco.ids[e];
    if (vertex_of_input[i] == kNoEntry) {
      vertex_of_input[i] = vertices++;
      first_entry[i] = e;
    } else {
      syntax.welds.push_back({e, first_entry[i]});
    }
  }
  if (!syntax.mesh.empty()) CodePositions(targets, draco, vertex_of_input, vertices, header, syntax);
  const std::vector<Vec3f> normal_of_input = NormalsOfVertices(input, normals);
  for (std::uint32_t i = 0; i < input.positions.size(); ++i) {
    if (vertex_of_input[i] != kNoEntry) continue;
    vertex_of_input[i] = vertices++;
    input_of_entry.push_back(i);
    LooseVertex& loose =
        syntax.loose_vertices.emplace_back(LooseVertex{Rounded(targets.cells[i], header.position_bits), {}, {}});
    if (syntax.has_normals) loose.normal = normal_of_input[i];
    if (syntax.has_colors) loose.color = input.colors[i];
  }

  // Triangles that did not come back.
  std::map<Triangle, std::int64_t> missing;
  for (const Triangle& t : input.triangles) ++missing[Canonical(t)];
  for (const Triangle& t : draco.triangles) --missing[Canonical({draco.ids[t[0]], draco.ids[t[1]], draco.ids[t[2]]})];
  for (const auto& [t, count] : missing) {
    if (count < 0) return Status::InvalidArgument("Draco invented a triangle");
    for (std::int64_t i = 0; i < count; ++i) {
      syntax.loose_triangles.push_back({vertex_of_input[t[0]], vertex_of_input[t[1]], vertex_of_input[t[2]]});
    }
  }

  SAC_RETURN_IF_ERROR(AssembleIFrame(syntax, header, std::move(draco), decoded));
  input_of_vertex.resize(vertices);
  for (std::size_t e = 0; e < input_of_entry.size(); ++e)
    input_of_vertex[decoded.vertex_of_entry[e]] = input_of_entry[e];
  return Status::Ok();
}

}  // namespace sac

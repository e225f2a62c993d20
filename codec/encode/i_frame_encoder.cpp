// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/i_frame_encoder.h"

#include <draco/compression/expert_encode.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "codec/encode/coded_normals.h"
#include "codec/encode/position_search.h"
#include "codec/vertex_copies.h"

namespace sac {
namespace {

constexpr int kUvBits = 12;
constexpr std::uint32_t kNoEntry = 0xffffffffu;

// What a point of Draco's has: its entry, texture coordinate, corner's normal and corner's colour, each an index, and
// the author's vertex.
enum PointIndex : std::size_t { kOfEntry, kOfUv, kOfNormal, kOfColor, kOfAuthor };
using Point = std::array<std::uint32_t, 5>;

// The part of a mesh that Draco is given: triangles with three different vertices, and the vertices they use.
struct DracoInput {
  std::vector<std::uint32_t> vertices;  // input vertex per entry
  std::vector<Triangle> triangles;      // of points
  std::vector<Point> points;
};

DracoInput SelectForDraco(const JoinedMesh& input, const CodedNormals& normals) {
  DracoInput out;
  const Mesh& mesh = input.mesh;
  std::vector<std::uint32_t> entry(mesh.positions.size(), kNoEntry);
  std::map<Point, std::uint32_t> point_of;
  for (std::size_t j = 0; j < mesh.triangles.size(); ++j) {
    const Triangle& t = mesh.triangles[j];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    const auto of_corner = [&](const std::vector<Triangle>& indices, std::size_t k) {
      return indices.empty() ? 0 : indices[j][k];
    };
    Triangle& points = out.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      if (entry[t[k]] == kNoEntry) {
        entry[t[k]] = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(t[k]);
      }
      const Point key = {entry[t[k]], of_corner(mesh.uv_triangles, k), of_corner(normals.triangles, k),
                         of_corner(input.color_triangles, k), input.author_triangles[j][k]};
      const auto [at, is_new] = point_of.try_emplace(key, static_cast<std::uint32_t>(out.points.size()));
      if (is_new) out.points.push_back(key);
      points[k] = at->second;
    }
  }
  return out;
}

// Adds an attribute whose values the points have by their index `index`.
template <class Value>
int AddAttribute(draco::Mesh& mesh, const DracoInput& input, draco::GeometryAttribute::Type type,
                 draco::DataType data_type, bool normalized, PointIndex index, const std::vector<Value>& values) {
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

// With `with_ids`, each corner also carries the author's vertex, to learn how Draco reorders and splits.
Status RunDraco(const JoinedMesh& input, const CodedNormals& normals, const DracoInput& selected, bool with_ids,
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
  AddAttribute(mesh, selected, Attribute::POSITION, draco::DT_INT32, false, kOfEntry,
               std::vector<std::array<std::int32_t, 3>>(selected.vertices.size()));
  int uv = -1, normal = -1;
  if (!input.mesh.uv_triangles.empty()) {
    uv = AddAttribute(mesh, selected, Attribute::TEX_COORD, draco::DT_FLOAT32, false, kOfUv, input.mesh.uvs);
  }
  if (!normals.triangles.empty()) {
    normal = AddAttribute(mesh, selected, Attribute::NORMAL, draco::DT_FLOAT32, false, kOfNormal, normals.values);
  } else if (!normals.values.empty()) {
    normal = AddAttribute(mesh, selected, Attribute::NORMAL, draco::DT_FLOAT32, false, kOfEntry,
                          Gather(normals.values, selected.vertices));
  }
  if (!input.color_triangles.empty()) {
    AddAttribute(mesh, selected, Attribute::COLOR, draco::DT_UINT8, true, kOfColor, input.corner_colors);
  } else if (!input.colors.empty()) {
    AddAttribute(mesh, selected, Attribute::COLOR, draco::DT_UINT8, true, kOfEntry,
                 Gather(input.colors, selected.vertices));
  }
  if (with_ids) {
    std::vector<std::array<std::uint32_t, 1>> ids(input.authors());
    for (std::uint32_t i = 0; i < ids.size(); ++i) ids[i] = {i};
    AddAttribute(mesh, selected, Attribute::GENERIC, draco::DT_UINT32, false, kOfAuthor, ids);
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

// Codes what Draco can take and decodes it again, with the author's vertices as ids. False when Draco fails on this
// mesh: then the whole mesh is coded loose.
bool TryDraco(const JoinedMesh& input, const CodedNormals& normals, const SequenceHeader& header,
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
  draco.ids = std::move(with_ids.ids);
  return true;
}

// The input's vertex of each of Draco's entries. False when an entry has none or several.
bool InputOfEntries(const JoinedMesh& input, const DracoMesh& draco, std::vector<std::uint32_t>& input_of_entry) {
  input_of_entry.assign(draco.entries, kNoEntry);
  for (std::size_t j = 0; j < draco.triangles.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = input.vertex_of_author[draco.ids[j][k]];
      std::uint32_t& of_entry = input_of_entry[draco.triangles[j][k]];
      if (of_entry != kNoEntry && of_entry != i) return false;
      of_entry = i;
    }
  }
  return std::find(input_of_entry.begin(), input_of_entry.end(), kNoEntry) == input_of_entry.end();
}

GridPosition Rounded(const std::array<double, 3>& cells, int bits) {
  GridPosition grid;
  for (std::size_t a = 0; a < 3; ++a) {
    grid[a] = static_cast<std::uint32_t>(std::clamp(std::round(cells[a]), 0.0, std::ldexp(1.0, bits) - 1));
  }
  return grid;
}

// Codes the positions of the vertices that Draco's entries are joined to.
void CodePositions(const PositionTargets& targets, const std::vector<std::uint32_t>& input_of_entry,
                   const DracoMesh& draco, const std::vector<std::uint32_t>& vertex_of_input, std::uint32_t vertices,
                   const SequenceHeader& header, IFrameSyntax& syntax) {
  std::vector<std::array<double, 3>> cells(vertices);
  for (const std::uint32_t i : input_of_entry) cells[vertex_of_input[i]] = targets.cells[i];
  std::vector<Triangle> triangles = draco.triangles;
  for (Triangle& t : triangles) {
    for (std::uint32_t& e : t) e = vertex_of_input[input_of_entry[e]];
  }
  syntax.position_step = targets.steps.base;
  syntax.position_slope = targets.steps.slope;
  syntax.positions = EncodePositions(cells, PositionGraph(vertices, triangles), targets.steps, header.position_bits);
}

// Adds the triangles that did not come back from Draco to `corners`, which are those of Draco's triangles; all are the
// author's vertices. kInvalidArgument when there are others instead.
Status AddMissing(const JoinedMesh& input, std::vector<Triangle>& corners) {
  std::map<Triangle, std::int64_t> missing;
  for (const Triangle& t : input.author_triangles) ++missing[Canonical(t)];
  for (const Triangle& t : corners) --missing[Canonical(t)];
  for (const auto& [t, count] : missing) {
    if (count < 0) return Status::InvalidArgument("Draco invented a triangle");
    corners.insert(corners.end(), static_cast<std::size_t>(count), t);
  }
  return Status::Ok();
}

// Codes which copy of its vertex each corner is: `corners` are the author's vertices, `vertex_of_author` the vertices
// that they are joined to.
void CodeCopies(const std::vector<Triangle>& corners, const std::vector<std::uint32_t>& vertex_of_author,
                const DracoMesh& draco, const SequenceHeader& header, IFrameSyntax& syntax) {
  std::vector<Triangle> triangles(corners), copies(corners);
  std::vector<std::uint32_t> count(header.vertices), copy_of_author(vertex_of_author.size(), kNoEntry);
  for (std::size_t j = 0; j < corners.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t author = corners[j][k], v = vertex_of_author[author];
      if (copy_of_author[author] == kNoEntry) copy_of_author[author] = count[v]++;
      triangles[j][k] = v;
      copies[j][k] = copy_of_author[author];
    }
  }
  const CornerKinds kinds =
      KindsOfCorners(triangles, draco.triangles.size(),
                     {&draco.uv_triangles, &draco.normal_triangles, &draco.color_triangles}, header.vertices);
  CopyCoder<RecordedBins>(header.vertices, triangles, kinds).Code(syntax.positions, header.copies, copies);
}

// The author's vertex of each vertex that decoders give out.
std::vector<std::uint32_t> OrderOf(const std::vector<Triangle>& corners, const std::vector<std::uint32_t>& loose,
                                   const DecodedIFrame& decoded) {
  const std::vector<std::uint32_t>& vertex_of_copy = decoded.mesh.vertex_of_copy;
  const bool has_copies = !vertex_of_copy.empty();
  std::vector<std::uint32_t> order(has_copies ? vertex_of_copy.size() : decoded.mesh.grid.size());
  for (std::size_t i = 0; i < loose.size(); ++i) {
    const std::uint32_t v = decoded.vertex_of_entry[decoded.vertex_of_entry.size() - loose.size() + i];
    const auto first = std::lower_bound(vertex_of_copy.begin(), vertex_of_copy.end(), v);
    order[has_copies ? static_cast<std::size_t>(first - vertex_of_copy.begin()) : v] = loose[i];
  }
  const std::vector<Triangle>& triangles = has_copies ? decoded.copy_triangles : decoded.mesh.triangles;
  for (std::size_t j = 0; j < corners.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) order[triangles[j][k]] = corners[j][k];
  }
  return order;
}

// The first of the author's vertices that each vertex of `input` is joined from.
std::vector<std::uint32_t> FirstAuthors(const JoinedMesh& input) {
  std::vector<std::uint32_t> first(input.mesh.positions.size());
  for (std::uint32_t i = static_cast<std::uint32_t>(input.authors()); i-- > 0;) first[input.vertex_of_author[i]] = i;
  return first;
}

}  // namespace

Status EncodeIFrameMesh(const JoinedMesh& input, const PositionTargets& targets, const SequenceHeader& header,
                        IFrameSyntax& syntax, DecodedIFrame& decoded, std::vector<std::uint32_t>& order) {
  DracoMesh draco;
  std::vector<std::uint32_t> input_of_entry;
  const CodedNormals normals = NormalsToCode(input.mesh);
  if (!TryDraco(input, normals, header, syntax.mesh, draco) || !InputOfEntries(input, draco, input_of_entry)) {
    syntax.mesh.clear();
    draco = {};
    input_of_entry.clear();
  }
  // Only Draco codes normals of corners; one a vertex would be wrong there.
  syntax.has_normals = !normals.values.empty() && (normals.triangles.empty() || !syntax.mesh.empty());
  syntax.has_colors = !input.colors.empty() && (input.color_triangles.empty() || !syntax.mesh.empty());

  // Vertices, in the numbering before components are sorted (spec.md 5.3): Draco's, then those it has not.
  const std::size_t inputs = input.mesh.positions.size();
  std::vector<std::uint32_t> vertex_of_input(inputs, kNoEntry), first_entry(inputs), loose_authors;
  std::uint32_t vertices = 0;
  for (std::uint32_t e = 0; e < draco.entries; ++e) {
    const std::uint32_t i = input_of_entry[e];
    if (vertex_of_input[i] == kNoEntry) {
      vertex_of_input[i] = vertices++;
      first_entry[i] = e;
    } else {
      syntax.welds.push_back({e, first_entry[i]});
    }
  }
  if (!syntax.mesh.empty()) {
    CodePositions(targets, input_of_entry, draco, vertex_of_input, vertices, header, syntax);
  }
  const std::vector<std::uint32_t> first_author = FirstAuthors(input);
  const std::vector<Vec3f> normal_of_input =
      input.own_normals.empty() ? NormalsOfVertices(input.mesh, normals) : input.own_normals;
  for (std::uint32_t i = 0; i < inputs; ++i) {
    if (vertex_of_input[i] != kNoEntry) continue;
    vertex_of_input[i] = vertices++;
    loose_authors.push_back(first_author[i]);
    LooseVertex& loose =
        syntax.loose_vertices.emplace_back(LooseVertex{Rounded(targets.cells[i], header.position_bits), {}, {}});
    if (syntax.has_normals) loose.normal = normal_of_input[i];
    if (syntax.has_colors) loose.color = input.colors[i];
  }

  std::vector<std::uint32_t> vertex_of_author = input.vertex_of_author;
  for (std::uint32_t& v : vertex_of_author) v = vertex_of_input[v];
  std::vector<Triangle> corners = draco.ids;
  SAC_RETURN_IF_ERROR(AddMissing(input, corners));
  for (std::size_t j = draco.triangles.size(); j < corners.size(); ++j) {
    const Triangle& t = corners[j];
    syntax.loose_triangles.push_back({vertex_of_author[t[0]], vertex_of_author[t[1]], vertex_of_author[t[2]]});
  }
  if (header.copies > 0) CodeCopies(corners, vertex_of_author, draco, header, syntax);
  SAC_RETURN_IF_ERROR(AssembleIFrame(syntax, header, std::move(draco), decoded));
  order = OrderOf(corners, loose_authors, decoded);
  return Status::Ok();
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/i_frame.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "codec/patches.h"
#include "codec/position_coder.h"
#include "format/recorded_bins.h"
#include "geometry/corner_groups.h"

namespace sac {
namespace {

// Returns what each of `count` vertices has: vertex[i] has values[i]. Empty when `values` are.
template <class Value>
std::vector<Value> Scatter(const std::vector<Value>& values, std::span<const std::uint32_t> vertex, std::size_t count) {
  std::vector<Value> out(values.empty() ? 0 : count);
  for (std::size_t i = 0; i < values.size(); ++i) out[vertex[i]] = values[i];
  return out;
}

// An I-frame that is being put together. `vertex` holds the vertex of each of Draco's entries, then of each loose
// vertex; `grid` holds the position of each vertex.
struct Assembly {
  DracoMesh draco;
  std::uint32_t vertices = 0;
  std::vector<std::uint32_t> vertex;
  std::vector<Triangle> triangles;
  std::vector<GridPosition> grid;
};

Status CheckAttributes(const IFrameSyntax& syntax, const DracoMesh& draco) {
  if (syntax.loose_vertices.empty()) return Status::Ok();
  if (!draco.normal_triangles.empty() && !syntax.has_normals) {
    return Status::Corrupt("I-frame: loose vertices without normals");
  }
  if (!draco.colors.empty() && !syntax.has_colors) return Status::Corrupt("I-frame: loose vertices without colours");
  return Status::Ok();
}

// Joins entries to vertices (spec.md 5.3, step 1): a welded entry shares the vertex of the entry that it is welded
// onto, the others are numbered in their order.
Status JoinEntries(const IFrameSyntax& syntax, const SequenceHeader& header, Assembly& out) {
  const std::uint32_t entries = out.draco.entries;
  out.vertex.resize(entries + syntax.loose_vertices.size());
  auto weld = syntax.welds.begin();
  for (std::uint32_t e = 0; e < entries; ++e) {
    if (weld != syntax.welds.end() && weld->point == e) {
      out.vertex[e] = out.vertex[weld->onto];
      ++weld;
    } else {
      out.vertex[e] = out.vertices++;
    }
  }
  if (weld != syntax.welds.end()) return Status::Corrupt("I-frame: a weld of a missing point");
  if (out.vertices + syntax.loose_vertices.size() != header.vertices) {
    return Status::Corrupt("I-frame: the number of vertices is not the header's");
  }
  out.triangles = std::move(out.draco.triangles);
  for (Triangle& t : out.triangles) {
    for (std::uint32_t& v : t) v = out.vertex[v];
  }
  return Status::Ok();
}

// Decodes the positions of the vertices that entries are joined to (spec.md 5.5). Their bins are recorded in `bins`
// unless it is null.
Status ReadPositions(const IFrameSyntax& syntax, const SequenceHeader& header, RangeDecoder& positions, Assembly& out,
                     RecordedBins* bins = nullptr) {
  if (!syntax.mesh.empty()) {
    SAC_RETURN_IF_ERROR(DecodePositions(positions, PositionGraph(out.vertices, out.triangles),
                                        {syntax.position_step, syntax.position_slope}, header.position_bits, out.grid,
                                        bins));
  }
  return positions.AtEnd() ? Status::Ok() : Status::Corrupt("I-frame: wrong length");
}

// Adds to `corners` those of the loose triangles: each takes the value of the first corner that its vertex has in
// Draco's mesh, or its vertex's own of `of_vertex`. `triangles` are Draco's, of vertices.
void AddLooseCorners(const std::vector<Triangle>& triangles, const std::vector<Triangle>& loose_triangles,
                     std::vector<std::uint32_t> of_vertex, std::vector<Triangle>& corners) {
  for (std::size_t j = corners.size(); j-- > 0;) {
    for (std::size_t k = 3; k-- > 0;) of_vertex[triangles[j][k]] = corners[j][k];
  }
  for (const Triangle& t : loose_triangles) corners.push_back({of_vertex[t[0]], of_vertex[t[1]], of_vertex[t[2]]});
}

// Brings the normals of Draco's corners, of loose triangles and of loose vertices together (spec.md 5.3). The triangles
// are all there already.
void JoinNormals(const IFrameSyntax& syntax, Assembly& out) {
  DracoMesh& draco = out.draco;
  const bool has_loose = syntax.has_normals && !syntax.loose_vertices.empty();
  if (draco.normal_triangles.empty() && !has_loose) return;
  const auto none = static_cast<std::uint32_t>(draco.normals.size());
  draco.normals.push_back({});  // where there is no normal
  std::vector<std::uint32_t> of_vertex(out.vertices, none);
  std::vector<Vec3f> loose(out.vertices);
  for (std::size_t i = 0; has_loose && i < syntax.loose_vertices.size(); ++i) {
    const std::uint32_t v = out.vertex[draco.entries + i];
    of_vertex[v] = static_cast<std::uint32_t>(draco.normals.size());
    loose[v] = syntax.loose_vertices[i].normal;
    draco.normals.push_back(loose[v]);
  }
  draco.normal_triangles.resize(out.triangles.size() - syntax.loose_triangles.size(), {none, none, none});
  AddLooseCorners(out.triangles, syntax.loose_triangles, std::move(of_vertex), draco.normal_triangles);
  MergeNormals(out.triangles, out.vertices, ClassesByBits(draco.normals), loose, draco.normals, draco.normal_triangles);
}

// Adds loose vertices and triangles after Draco's (spec.md 5.3, step 1).
Status AddLooseParts(const IFrameSyntax& syntax, const SequenceHeader& header, Assembly& out) {
  DracoMesh& draco = out.draco;
  if (out.triangles.size() + syntax.loose_triangles.size() != header.triangles) {
    return Status::Corrupt("I-frame: the number of triangles is not the header's");
  }
  if (syntax.has_colors && !syntax.loose_vertices.empty()) draco.colors.resize(draco.entries);
  for (std::size_t i = 0; i < syntax.loose_vertices.size(); ++i) {
    const LooseVertex& v = syntax.loose_vertices[i];
    out.vertex[draco.entries + i] = out.vertices++;
    out.grid.push_back(v.position);
    if (syntax.has_colors) draco.colors.push_back(v.color);
  }
  if (!draco.uv_triangles.empty()) {
    AddLooseCorners(out.triangles, syntax.loose_triangles, std::vector<std::uint32_t>(out.vertices),
                    draco.uv_triangles);
  }
  out.triangles.insert(out.triangles.end(), syntax.loose_triangles.begin(), syntax.loose_triangles.end());
  JoinNormals(syntax, out);
  return Status::Ok();
}

// Renumbers the vertices by component and, within it, by patch, so that each of these is a run (spec.md 5.3, step 2).
// Returns the new number of each vertex.
std::vector<std::uint32_t> Renumber(std::uint32_t patch_size, Assembly& parts, DecodedMesh& mesh) {
  std::uint32_t components = 0;
  const std::vector<std::uint32_t> label = LabelComponents(parts.vertices, parts.triangles, components);
  std::vector<std::vector<std::uint32_t>> members(components);
  for (std::uint32_t v = 0; v < parts.vertices; ++v) members[label[v]].push_back(v);
  const VertexGraph graph = BuildGraph(parts.vertices, parts.triangles);
  std::vector<std::uint32_t> renumbered(parts.vertices);
  std::uint32_t next = 0, next_patch = 0;
  for (std::vector<std::uint32_t>& component : members) {
    mesh.components.push_back({next, static_cast<std::uint32_t>(component.size())});
    const PatchOrder patches = CutIntoPatches(parts.grid, graph, std::move(component), patch_size);
    for (const std::uint32_t v : patches.vertices) renumbered[v] = next++;
    for (const std::uint32_t size : patches.sizes) {
      mesh.patches.push_back({next_patch, size});
      next_patch += size;
    }
  }
  for (Triangle& t : parts.triangles) {
    for (std::uint32_t& v : t) v = renumbered[v];
  }
  for (std::uint32_t& v : parts.vertex) v = renumbered[v];
  mesh.grid = Scatter(parts.grid, renumbered, parts.vertices);
  mesh.triangles = std::move(parts.triangles);
  return renumbered;
}

}  // namespace

Status AssembleIFrame(const IFrameSyntax& syntax, const SequenceHeader& header, DracoMesh draco,
                      RangeDecoder& positions, DecodedIFrame& out) {
  Assembly parts;
  parts.draco = std::move(draco);
  SAC_RETURN_IF_ERROR(CheckAttributes(syntax, parts.draco));
  SAC_RETURN_IF_ERROR(JoinEntries(syntax, header, parts));
  SAC_RETURN_IF_ERROR(ReadPositions(syntax, header, positions, parts));
  SAC_RETURN_IF_ERROR(AddLooseParts(syntax, header, parts));
  std::vector<std::uint32_t> renumbered = Renumber(header.patch_size, parts, out.mesh);
  out.normals = std::move(parts.draco.normals);
  out.normal_triangles = std::move(parts.draco.normal_triangles);
  if (out.normal_triangles.empty()) out.normals = Scatter(out.normals, renumbered, parts.vertices);
  out.colors = Scatter(parts.draco.colors, parts.vertex, parts.vertices);
  out.uvs = std::move(parts.draco.uvs);
  out.uv_triangles = std::move(parts.draco.uv_triangles);
  out.vertex_of_entry = std::move(parts.vertex);
  return Status::Ok();
}

Status AssembleIFrame(const IFrameSyntax& syntax, const SequenceHeader& header, DracoMesh draco, DecodedIFrame& out) {
  RangeEncoder coder;
  syntax.positions.WriteTo(coder);
  const std::vector<std::uint8_t> bytes = coder.Finish();
  RangeDecoder positions(bytes);
  return AssembleIFrame(syntax, header, std::move(draco), positions, out);
}

Status ReadIFrame(std::span<const std::uint8_t> payload, const SequenceHeader& header, IFrameSyntax& syntax) {
  RangeDecoder positions({});
  SAC_RETURN_IF_ERROR(ParseIFrame(payload, header, syntax, positions));
  Assembly parts;
  SAC_RETURN_IF_ERROR(DecodeDraco(syntax.mesh, header, parts.draco));
  SAC_RETURN_IF_ERROR(JoinEntries(syntax, header, parts));
  return ReadPositions(syntax, header, positions, parts, &syntax.positions);
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/i_frame.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>

#include "codec/patches.h"
#include "codec/position_coder.h"
#include "codec/vertex_copies.h"
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
// vertex; `grid` holds the position of each vertex. Attributes are those of copies (spec.md 5.6): vertex v has the
// copies from first_copy[v] on. Where there is one of each, these are the vertices.
struct Assembly {
  DracoMesh draco;
  std::uint32_t vertices = 0;
  std::vector<std::uint32_t> vertex;
  std::vector<Triangle> triangles;
  std::vector<GridPosition> grid;
  std::vector<std::uint32_t> first_copy;  // and one more; empty where there is one of each
  std::vector<Triangle> corners;          // of copies; empty likewise

  std::size_t copies() const { return first_copy.empty() ? vertices : first_copy.back(); }
  const std::vector<Triangle>& copy_triangles() const { return first_copy.empty() ? triangles : corners; }
  // The copies of a vertex: from the first to before the second.
  std::pair<std::uint32_t, std::uint32_t> CopiesOf(std::uint32_t v) const {
    return first_copy.empty() ? std::pair(v, v + 1) : std::pair(first_copy[v], first_copy[v + 1]);
  }
};

Status CheckAttributes(const IFrameSyntax& syntax, const DracoMesh& draco) {
  if (syntax.loose_vertices.empty()) return Status::Ok();
  if (!draco.normal_triangles.empty() && !syntax.has_normals) {
    return Status::Corrupt("I-frame: loose vertices without normals");
  }
  if (!draco.color_triangles.empty() && !syntax.has_colors)
    return Status::Corrupt("I-frame: loose vertices without colours");
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
  return Status::Ok();
}

// Decodes which copy of its vertex each corner has (spec.md 5.6), with which the range code ends. Their bins are
// recorded in `bins` unless it is null.
Status ReadCopies(const IFrameSyntax& syntax, const SequenceHeader& header, RangeDecoder& range, Assembly& out,
                  RecordedBins* bins = nullptr) {
  if (header.copies > 0) {
    const DracoMesh& draco = out.draco;
    const CornerKinds kinds =
        KindsOfCorners(out.triangles, out.triangles.size() - syntax.loose_triangles.size(),
                       {&draco.uv_triangles, &draco.normal_triangles, &draco.color_triangles}, out.vertices);
    CopyCoder<RangeDecoder> coder(out.vertices, out.triangles, kinds);
    if (!coder.Code(range, header.copies, out.corners)) return Status::Corrupt("I-frame: malformed copies of vertices");
    if (bins) CopyCoder<RecordedBins>(out.vertices, out.triangles, kinds).Code(*bins, header.copies, out.corners);
    out.first_copy = {0};
    std::inclusive_scan(coder.counts().begin(), coder.counts().end(), std::back_inserter(out.first_copy));
    if (out.copies() != header.given_out()) {
      return Status::Corrupt("I-frame: the number of copies is not the header's");
    }
    for (std::size_t j = 0; j < out.corners.size(); ++j) {
      for (std::size_t k = 0; k < 3; ++k) out.corners[j][k] += out.first_copy[out.triangles[j][k]];
    }
  }
  return range.AtEnd() ? Status::Ok() : Status::Corrupt("I-frame: wrong length");
}

// Adds loose vertices and triangles after Draco's (spec.md 5.3, step 1).
Status AddLooseParts(const IFrameSyntax& syntax, const SequenceHeader& header, Assembly& out) {
  if (out.triangles.size() + syntax.loose_triangles.size() != header.triangles) {
    return Status::Corrupt("I-frame: the number of triangles is not the header's");
  }
  for (std::size_t i = 0; i < syntax.loose_vertices.size(); ++i) {
    out.vertex[out.draco.entries + i] = out.vertices++;
    out.grid.push_back(syntax.loose_vertices[i].position);
  }
  out.triangles.insert(out.triangles.end(), syntax.loose_triangles.begin(), syntax.loose_triangles.end());
  return Status::Ok();
}

// Adds to `corners`, which has those of Draco's triangles, the corners of the loose ones: each takes the value of the
// first corner that its copy has in Draco's mesh, or its copy's own of `of_copy`. `triangles` are all, of copies.
void AddLooseCorners(const std::vector<Triangle>& triangles, std::vector<std::uint32_t> of_copy,
                     std::vector<Triangle>& corners) {
  for (std::size_t j = corners.size(); j-- > 0;) {
    for (std::size_t k = 3; k-- > 0;) of_copy[triangles[j][k]] = corners[j][k];
  }
  for (std::size_t j = corners.size(); j < triangles.size(); ++j) {
    const Triangle& t = triangles[j];
    corners.push_back({of_copy[t[0]], of_copy[t[1]], of_copy[t[2]]});
  }
}

// Brings the normals of Draco's corners, of loose triangles and of loose vertices together (spec.md 5.3).
void JoinNormals(const IFrameSyntax& syntax, Assembly& out) {
  DracoMesh& draco = out.draco;
  const bool has_loose = syntax.has_normals && !syntax.loose_vertices.empty();
  if (draco.normal_triangles.empty() && !has_loose) return;
  const auto none = static_cast<std::uint32_t>(draco.normals.size());
  draco.normals.push_back({});  // where there is no normal
  std::vector<std::uint32_t> of_copy(out.copies(), none);
  std::vector<Vec3f> loose(out.copies());
  for (std::size_t i = 0; has_loose && i < syntax.loose_vertices.size(); ++i) {
    const auto [first, end] = out.CopiesOf(out.vertex[draco.entries + i]);
    std::fill(of_copy.begin() + first, of_copy.begin() + end, static_cast<std::uint32_t>(draco.normals.size()));
    std::fill(loose.begin() + first, loose.begin() + end, syntax.loose_vertices[i].normal);
    draco.normals.push_back(syntax.loose_vertices[i].normal);
  }
  draco.normal_triangles.resize(out.triangles.size() - syntax.loose_triangles.size(), {none, none, none});
  AddLooseCorners(out.copy_triangles(), std::move(of_copy), draco.normal_triangles);
  MergeNormals(out.copy_triangles(), out.copies(), ClassesByBits(draco.normals), loose, draco.normals,
               draco.normal_triangles);
}

// The colour of each copy: that of its last corner in Draco's mesh, or of its loose vertex (spec.md 5.3).
std::vector<std::array<std::uint8_t, 4>> JoinColors(const IFrameSyntax& syntax, const Assembly& parts) {
  const bool has_loose = syntax.has_colors && !syntax.loose_vertices.empty();
  const std::vector<Triangle>& corners = parts.draco.color_triangles;
  if (corners.empty() && !has_loose) return {};
  std::vector<std::array<std::uint8_t, 4>> colors(parts.copies());
  for (std::size_t i = 0; has_loose && i < syntax.loose_vertices.size(); ++i) {
    const auto [first, end] = parts.CopiesOf(parts.vertex[parts.draco.entries + i]);
    std::fill(colors.begin() + first, colors.begin() + end, syntax.loose_vertices[i].color);
  }
  for (std::size_t j = 0; j < corners.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) colors[parts.copy_triangles()[j][k]] = parts.draco.colors[corners[j][k]];
  }
  return colors;
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

// Numbers the copies by the new numbers of their vertices, `renumbered`. Returns the new number of each copy.
std::vector<std::uint32_t> RenumberCopies(const std::vector<std::uint32_t>& renumbered, const Assembly& parts,
                                          DecodedIFrame& out) {
  if (parts.first_copy.empty()) return renumbered;
  std::vector<std::uint32_t> counts(parts.vertices);
  for (std::uint32_t v = 0; v < parts.vertices; ++v) {
    counts[renumbered[v]] = parts.first_copy[v + 1] - parts.first_copy[v];
  }
  std::vector<std::uint32_t> first(parts.vertices), copies(parts.copies());
  std::exclusive_scan(counts.begin(), counts.end(), first.begin(), 0u);
  for (std::uint32_t v = 0; v < parts.vertices; ++v) {
    out.mesh.vertex_of_copy.insert(out.mesh.vertex_of_copy.end(), counts[v], v);
    const auto begin = copies.begin() + parts.first_copy[v];
    std::iota(begin, begin + counts[renumbered[v]], first[renumbered[v]]);
  }
  out.copy_triangles = parts.corners;
  for (Triangle& t : out.copy_triangles) {
    for (std::uint32_t& c : t) c = copies[c];
  }
  return copies;
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
  SAC_RETURN_IF_ERROR(ReadCopies(syntax, header, positions, parts));
  std::vector<std::array<std::uint8_t, 4>> colors = JoinColors(syntax, parts);
  if (!parts.draco.uv_triangles.empty()) {
    AddLooseCorners(parts.copy_triangles(), std::vector<std::uint32_t>(parts.copies()), parts.draco.uv_triangles);
  }
  JoinNormals(syntax, parts);
  const std::vector<std::uint32_t> renumbered = Renumber(header.patch_size, parts, out.mesh);
  const std::vector<std::uint32_t> copies = RenumberCopies(renumbered, parts, out);
  if (!syntax.scales.empty() && syntax.scales.size() != out.mesh.components.size()) {
    return Status::Corrupt("I-frame: scales of " + std::to_string(syntax.scales.size()) + " components, there are " +
                           std::to_string(out.mesh.components.size()));
  }
  out.mesh.scales = syntax.scales;
  out.normals = std::move(parts.draco.normals);
  out.normal_triangles = std::move(parts.draco.normal_triangles);
  if (out.normal_triangles.empty()) out.normals = Scatter(out.normals, copies, copies.size());
  out.colors = Scatter(colors, copies, copies.size());
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
  SAC_RETURN_IF_ERROR(ReadPositions(syntax, header, positions, parts, &syntax.positions));
  SAC_RETURN_IF_ERROR(AddLooseParts(syntax, header, parts));
  return ReadCopies(syntax, header, positions, parts, &syntax.positions);
}

}  // namespace sac

#include "codec/i_frame.h"

#include <algorithm>
#include <utility>

#include "codec/patches.h"
#include "codec/position_coder.h"

namespace sac {
namespace {

// values[i] goes to vertex[i].
template <class Value>
std::vector<Value> Scatter(const std::vector<Value>& values, std::span<const std::uint32_t> vertex, std::size_t count) {
  std::vector<Value> out(values.empty() ? 0 : count);
  for (std::size_t i = 0; i < values.size(); ++i) out[vertex[i]] = values[i];
  return out;
}

}  // namespace

Status AssembleIFrame(const IFrameSyntax& syntax, const SequenceHeader& header, DracoMesh draco, DecodedIFrame& out) {
  // 1. Welded entries share the vertex of the entry they are welded onto; the others are numbered as they come.
  const std::size_t entries = draco.entries;
  std::vector<std::uint32_t> vertex(entries + syntax.loose_vertices.size());
  std::uint32_t vertices = 0;
  auto weld = syntax.welds.begin();
  for (std::uint32_t e = 0; e < entries; ++e) {
    if (weld != syntax.welds.end() && weld->point == e) {
      vertex[e] = vertex[weld->onto];
      ++weld;
    } else {
      vertex[e] = vertices++;
    }
  }
  if (weld != syntax.welds.end()) return Status::Corrupt("I-frame: a weld of a missing point");

  std::vector<Triangle> triangles = std::move(draco.triangles);
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = vertex[v];
  }

  if (!draco.normals.empty() && !syntax.has_normals && !syntax.loose_vertices.empty()) {
    return Status::Corrupt("I-frame: loose vertices without normals");
  }
  if (!draco.colors.empty() && !syntax.has_colors && !syntax.loose_vertices.empty()) {
    return Status::Corrupt("I-frame: loose vertices without colours");
  }

  if (vertices + syntax.loose_vertices.size() != header.vertices) {
    return Status::Corrupt("I-frame: the number of vertices is not the header's");
  }

  // 2. Their positions.
  std::vector<GridPosition> grid;
  if (!syntax.mesh.empty()) {
    SAC_RETURN_IF_ERROR(DecodePositions(syntax.positions, PositionGraph(vertices, triangles),
                                        {syntax.position_step, syntax.position_slope}, header.position_bits, grid));
  }

  // 3. Loose vertices and triangles come after Draco's.
  for (std::size_t i = 0; i < syntax.loose_vertices.size(); ++i) {
    const LooseVertex& v = syntax.loose_vertices[i];
    vertex[entries + i] = vertices++;
    grid.push_back(v.position);
    if (syntax.has_normals) draco.normals.resize(entries + i), draco.normals.push_back(v.normal);
    if (syntax.has_colors) draco.colors.resize(entries + i), draco.colors.push_back(v.color);
  }
  if (triangles.size() + syntax.loose_triangles.size() != header.triangles) {
    return Status::Corrupt("I-frame: the number of triangles is not the header's");
  }
  triangles.insert(triangles.end(), syntax.loose_triangles.begin(), syntax.loose_triangles.end());
  if (!draco.uv_triangles.empty() && !syntax.loose_triangles.empty()) {
    // A loose triangle's corner takes the texture coordinate of the vertex's first corner in Draco's mesh.
    std::vector<std::uint32_t> uv_of_vertex(vertices, 0);
    for (std::size_t j = draco.uv_triangles.size(); j-- > 0;) {
      for (std::size_t k = 3; k-- > 0;) uv_of_vertex[triangles[j][k]] = draco.uv_triangles[j][k];
    }
    for (const Triangle& t : syntax.loose_triangles) {
      draco.uv_triangles.push_back({uv_of_vertex[t[0]], uv_of_vertex[t[1]], uv_of_vertex[t[2]]});
    }
  }

  // 4. Renumber by component and patch, so that each is a run of vertices.
  std::uint32_t components = 0;
  const std::vector<std::uint32_t> label = LabelComponents(vertices, triangles, components);
  std::vector<std::vector<std::uint32_t>> members(components);
  for (std::uint32_t v = 0; v < vertices; ++v) members[label[v]].push_back(v);
  const VertexGraph graph = BuildGraph(vertices, triangles);
  std::vector<std::uint32_t> renumbered(vertices);
  std::uint32_t next = 0, next_patch = 0;
  for (std::vector<std::uint32_t>& component : members) {
    out.mesh.components.push_back({next, static_cast<std::uint32_t>(component.size())});
    const PatchOrder patches = CutIntoPatches(grid, graph, std::move(component), header.patch_size);
    for (const std::uint32_t v : patches.vertices) renumbered[v] = next++;
    for (const std::uint32_t size : patches.sizes) {
      out.mesh.patches.push_back({next_patch, size});
      next_patch += size;
    }
  }
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = renumbered[v];
  }
  for (std::uint32_t& v : vertex) v = renumbered[v];

  out.mesh.grid = Scatter(grid, renumbered, vertices);
  out.mesh.triangles = std::move(triangles);
  out.normals = Scatter(draco.normals, vertex, vertices);
  out.colors = Scatter(draco.colors, vertex, vertices);
  out.uvs = std::move(draco.uvs);
  out.uv_triangles = std::move(draco.uv_triangles);
  out.vertex_of_entry = std::move(vertex);
  return Status::Ok();
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/joined_mesh.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "geometry/corner_groups.h"

namespace sac {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

// The number of the joined vertex of each of the author's. They are numbered in the order of their first.
std::vector<std::uint32_t> NumberJoined(const Mesh& mesh, std::span<const std::uint32_t> lowest) {
  std::vector<std::uint32_t> joined(mesh.positions.size());
  if (lowest.empty()) {
    std::iota(joined.begin(), joined.end(), 0u);
    return joined;
  }
  std::vector<bool> is_corner(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    if (lowest[t[0]] == lowest[t[1]] || lowest[t[1]] == lowest[t[2]] || lowest[t[2]] == lowest[t[0]]) continue;
    for (const std::uint32_t v : t) is_corner[v] = true;
  }
  std::vector<std::uint32_t> of_lowest(mesh.positions.size(), kNone);
  std::uint32_t next = 0;
  for (std::uint32_t v = 0; v < joined.size(); ++v) {
    std::uint32_t number = next;
    if (is_corner[v]) {
      if (of_lowest[lowest[v]] == kNone) of_lowest[lowest[v]] = next;
      number = of_lowest[lowest[v]];
    }
    joined[v] = number;
    if (number == next) ++next;
  }
  return joined;
}

// Gives equal texture coordinates one number, so that no seam is coded between those of vertices that are joined.
void MergeEqual(std::vector<std::array<float, 2>>& uvs, std::vector<Triangle>& uv_triangles) {
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> number;
  std::vector<std::uint32_t> merged(uvs.size());
  std::vector<std::array<float, 2>> values;
  for (std::size_t i = 0; i < uvs.size(); ++i) {
    const auto bits = std::bit_cast<std::array<std::uint32_t, 2>>(uvs[i]);
    const auto [at, is_new] = number.try_emplace(bits, static_cast<std::uint32_t>(values.size()));
    if (is_new) values.push_back(uvs[i]);
    merged[i] = at->second;
  }
  for (Triangle& t : uv_triangles) {
    for (std::uint32_t& i : t) i = merged[i];
  }
  uvs = std::move(values);
}

// Brings the colours of the author's vertices to those that they are joined to, or to corners where these differ.
void JoinColors(const std::vector<std::array<std::uint8_t, 4>>& colors, JoinedMesh& out) {
  if (colors.empty()) return;
  out.colors.resize(out.mesh.positions.size());
  for (std::size_t i = colors.size(); i-- > 0;) out.colors[out.vertex_of_author[i]] = colors[i];
  bool agree = true;
  for (std::size_t i = 0; i < colors.size(); ++i) agree = agree && out.colors[out.vertex_of_author[i]] == colors[i];
  if (agree) return;
  std::vector<Triangle> classes = out.author_triangles;
  for (Triangle& t : classes) {
    for (std::uint32_t& v : t) v = std::bit_cast<std::uint32_t>(colors[v]);
  }
  CornerGroups groups = GroupCorners(out.mesh.triangles, classes);
  for (const std::size_t c : groups.first) out.corner_colors.push_back(colors[out.author_triangles[c / 3][c % 3]]);
  out.color_triangles = std::move(groups.triangles);
}

}  // namespace

Status CheckJoining(std::span<const std::uint32_t> lowest, std::size_t vertices) {
  if (lowest.empty()) return Status::Ok();
  if (lowest.size() != vertices) return Status::InvalidArgument("vertices to join for some vertices only");
  for (std::size_t v = 0; v < vertices; ++v) {
    if (lowest[v] > v || lowest[lowest[v]] != lowest[v]) {
      return Status::InvalidArgument("vertex " + std::to_string(v) + " is to be joined with a vertex that is no first");
    }
  }
  return Status::Ok();
}

JoinedMesh JoinVertices(const Mesh& mesh, std::span<const std::uint32_t> lowest) {
  JoinedMesh out;
  out.vertex_of_author = NumberJoined(mesh, lowest);
  out.author_triangles = mesh.triangles;
  out.mesh = mesh;
  out.mesh.colors.clear();
  if (mesh.normal_triangles.empty()) out.own_normals = mesh.normals;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const std::uint32_t v = out.vertex_of_author[i];
    if (v < count) continue;
    out.mesh.positions[v] = mesh.positions[i];
    if (!out.own_normals.empty()) out.own_normals[v] = mesh.normals[i];
    ++count;
  }
  out.mesh.positions.resize(count);
  if (!out.own_normals.empty()) out.own_normals.resize(count);
  for (Triangle& t : out.mesh.triangles) {
    for (std::uint32_t& v : t) v = out.vertex_of_author[v];
  }
  if (out.is_joined()) {
    MergeEqual(out.mesh.uvs, out.mesh.uv_triangles);
    if (!out.own_normals.empty()) out.mesh.normal_triangles = out.author_triangles;
  }
  JoinColors(mesh.colors, out);
  return out;
}

}  // namespace sac

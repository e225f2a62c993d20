// SPDX-License-Identifier: Apache-2.0
#include "files/split_vertices.h"

#include <array>
#include <limits>
#include <map>

namespace sac {

SplitVertices SplitAtSeams(const Mesh& mesh) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  const bool has_uvs = !mesh.uvs.empty(), has_normals = !mesh.normals.empty();
  const bool normals_of_corners = has_normals && !mesh.normal_triangles.empty();
  SplitVertices split;
  for (std::uint32_t v = 0; v < count; ++v) split.vertices.push_back(v);
  if (has_uvs) split.uvs.assign(count, kNone);
  if (has_normals) split.normals = split.vertices;
  if (normals_of_corners) split.normals.assign(count, kNone);
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> others;  // by vertex, texture coordinates and normal
  std::vector<bool> met(count);
  for (std::size_t j = 0; j < mesh.triangles.size(); ++j) {
    Triangle triangle{};
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[j][k], uv = has_uvs ? mesh.uv_triangles[j][k] : kNone;
      const std::uint32_t normal = normals_of_corners ? mesh.normal_triangles[j][k] : has_normals ? v : kNone;
      if (!met[v]) {
        met[v] = true;
        if (has_uvs) split.uvs[v] = uv;
        if (has_normals) split.normals[v] = normal;
      }
      triangle[k] = v;
      if ((has_uvs && split.uvs[v] != uv) || (has_normals && split.normals[v] != normal)) {
        const auto [found, added] = others.try_emplace({v, uv, normal}, static_cast<std::uint32_t>(split.size()));
        if (added) {
          split.vertices.push_back(v);
          if (has_uvs) split.uvs.push_back(uv);
          if (has_normals) split.normals.push_back(normal);
        }
        triangle[k] = found->second;
      }
    }
    split.triangles.push_back(triangle);
  }
  for (auto* indices : {&split.uvs, &split.normals}) {
    for (std::uint32_t& index : *indices) index = index == kNone ? 0 : index;
  }
  return split;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "files/obj_file.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

namespace sac {
namespace {

void Append(std::string& text, float value) {
  char digits[32];
  text += ' ';
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

}  // namespace

std::string FormatObj(const Mesh& mesh) {
  const bool alpha = std::any_of(mesh.colors.begin(), mesh.colors.end(), [](const auto& c) { return c[3] != 255; });
  std::string text;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    text += 'v';
    for (const float x : mesh.positions[i]) Append(text, x);
    if (!mesh.colors.empty()) {
      for (int k = 0; k < (alpha ? 4 : 3); ++k) Append(text, static_cast<float>(mesh.colors[i][k]) / 255.0F);
    }
    text += '\n';
  }
  for (const auto& uv : mesh.uvs) {
    text += "vt";
    for (const float x : uv) Append(text, x);
    text += '\n';
  }
  for (const Vec3f& normal : mesh.normals) {
    text += "vn";
    for (const float x : normal) Append(text, x);
    text += '\n';
  }
  for (std::size_t j = 0; j < mesh.triangles.size(); ++j) {
    text += 'f';
    for (int k = 0; k < 3; ++k) {
      const std::string vertex = std::to_string(mesh.triangles[j][k] + std::uint64_t{1});
      text += ' ' + vertex;
      if (!mesh.uvs.empty()) text += '/' + std::to_string(mesh.uv_triangles[j][k] + std::uint64_t{1});
      if (!mesh.normals.empty()) text += (mesh.uvs.empty() ? "//" : "/") + vertex;
    }
    text += '\n';
  }
  return text;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "files/obj_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <vector>

namespace sac {
namespace {

template <class Number>
void Append(std::string& text, Number value) {
  char digits[32];
  text += ' ';
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

}  // namespace

std::string FormatObj(const Mesh& mesh, const std::array<double, 3>& offset) {
  const bool alpha = std::any_of(mesh.colors.begin(), mesh.colors.end(), [](const auto& c) { return c[3] != 255; });
  std::string text;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    text += 'v';
    for (std::size_t a = 0; a < 3; ++a) {
      const float x = mesh.positions[i][a];
      offset[a] == 0 ? Append(text, x) : Append(text, offset[a] + static_cast<double>(x));
    }
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
  const auto number = [](std::uint32_t index) { return std::to_string(index + std::uint64_t{1}); };
  const std::vector<Triangle>& normals = mesh.normal_triangles.empty() ? mesh.triangles : mesh.normal_triangles;
  for (std::size_t j = 0; j < mesh.triangles.size(); ++j) {
    text += 'f';
    for (int k = 0; k < 3; ++k) {
      text += ' ' + number(mesh.triangles[j][k]);
      if (!mesh.uvs.empty()) text += '/' + number(mesh.uv_triangles[j][k]);
      if (!mesh.normals.empty()) text += (mesh.uvs.empty() ? "//" : "/") + number(normals[j][k]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "files/obj_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "files/text_scan.h"
#include "files/uv_table.h"

namespace sac {
namespace {

constexpr std::int64_t kAbsent = -1;

// Zero-based indices; kAbsent where the corner names none.
struct Corner {
  std::int64_t vertex = kAbsent, uv = kAbsent, normal = kAbsent;
};

struct ObjData {
  Positions positions;
  std::vector<std::optional<std::array<float, 4>>> colors;  // one per position
  std::vector<std::array<float, 2>> uvs;
  std::vector<Vec3f> normals;
  std::vector<std::array<Corner, 3>> triangles;
  std::vector<std::size_t> triangle_lines;
  std::vector<std::string_view> words;  // of the statement at hand, without its keyword
};

// A statement: one line, or several joined by a backslash at the end. A comment may end in one too (a path, say).
std::string_view TakeStatement(std::string_view& text, std::size_t& line_count) {
  const char* begin = text.data();
  std::string_view line;
  do {
    line = TakeLine(text);
    ++line_count;
    while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  } while (!line.empty() && line.back() == '\\' && *begin != '#' && !text.empty());
  return {begin, static_cast<std::size_t>(line.data() + line.size() - begin)};
}

Status ParseNumbers(const ObjData& obj, std::size_t least, std::array<float, 7>& values, std::size_t& count) {
  if (obj.words.size() < least) return Status::Corrupt("expected " + std::to_string(least) + " numbers");
  count = std::min(obj.words.size(), values.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (!ParseFloat(obj.words[i], values[i])) return Status::Corrupt("not a number: " + std::string(obj.words[i]));
  }
  return Status::Ok();
}

// OBJ counts from 1, or with negative numbers back from the last element so far.
Status ParseIndex(std::string_view word, std::size_t count, std::int64_t& index) {
  std::int64_t value = 0;
  if (!ParseInteger(word, value)) return Status::Corrupt("not an index: " + std::string(word));
  index = value > 0 ? value - 1 : static_cast<std::int64_t>(count) + value;
  if (value == 0 || index < 0) return Status::Corrupt("index out of range: " + std::string(word));
  return Status::Ok();
}

Status ParseCorner(const ObjData& obj, std::string_view word, Corner& corner) {
  const std::size_t counts[] = {obj.positions.size(), obj.uvs.size(), obj.normals.size()};
  std::int64_t* const indices[] = {&corner.vertex, &corner.uv, &corner.normal};
  for (int i = 0; i < 3; ++i) {
    const std::size_t end = word.find('/');
    if (const std::string_view part = word.substr(0, end); i == 0 || !part.empty()) {
      SAC_RETURN_IF_ERROR(ParseIndex(part, counts[i], *indices[i]));
    }
    if (end == std::string_view::npos) return Status::Ok();
    word.remove_prefix(end + 1);
  }
  return Status::Corrupt("a corner of more than three indices");
}

Status ParseFace(ObjData& obj, std::size_t line) {
  std::vector<Corner> corners(obj.words.size());
  for (std::size_t k = 0; k < corners.size(); ++k) SAC_RETURN_IF_ERROR(ParseCorner(obj, obj.words[k], corners[k]));
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    obj.triangles.push_back({corners[0], corners[k], corners[k + 1]});
    obj.triangle_lines.push_back(line);
  }
  return Status::Ok();
}

Status ParseStatement(ObjData& obj, std::string_view keyword, std::size_t line) {
  std::array<float, 7> x{};
  std::size_t count = 0;
  if (keyword == "v") {
    SAC_RETURN_IF_ERROR(ParseNumbers(obj, 3, x, count));
    obj.positions.push_back({x[0], x[1], x[2]});
    obj.colors.emplace_back();
    // Four or five numbers are a weight, which an animated mesh has no use for.
    if (count >= 6) obj.colors.back() = {x[3], x[4], x[5], count == 7 ? x[6] : 1.0F};
  } else if (keyword == "vt") {
    SAC_RETURN_IF_ERROR(ParseNumbers(obj, 1, x, count));
    obj.uvs.push_back({x[0], x[1]});
  } else if (keyword == "vn") {
    SAC_RETURN_IF_ERROR(ParseNumbers(obj, 3, x, count));
    obj.normals.push_back({x[0], x[1], x[2]});
  } else if (keyword == "f") {
    SAC_RETURN_IF_ERROR(ParseFace(obj, line));
  }
  return Status::Ok();
}

// Only now, because a face may name vertices that follow it.
Status CheckIndices(const ObjData& obj) {
  const auto fits = [](std::int64_t index, std::size_t count) { return index < static_cast<std::int64_t>(count); };
  for (std::size_t j = 0; j < obj.triangles.size(); ++j) {
    for (const Corner& corner : obj.triangles[j]) {
      const auto message = [&](const char* what, std::int64_t index, std::size_t count) {
        return Status::Corrupt("line " + std::to_string(obj.triangle_lines[j]) + ": " + what + " " +
                               std::to_string(index + 1) + ", but there are " + std::to_string(count));
      };
      if (!fits(corner.vertex, obj.positions.size())) return message("vertex", corner.vertex, obj.positions.size());
      if (!fits(corner.uv, obj.uvs.size())) return message("texture vertex", corner.uv, obj.uvs.size());
      if (!fits(corner.normal, obj.normals.size())) return message("normal", corner.normal, obj.normals.size());
    }
  }
  return Status::Ok();
}

void TakeColors(const ObjData& obj, Mesh& mesh) {
  bool any = false;
  float largest = 0;
  for (const auto& color : obj.colors) {
    any |= color.has_value();
    if (color) largest = std::max({largest, (*color)[0], (*color)[1], (*color)[2]});
  }
  if (!any) return;
  // Most writers use 0..1, some 0..255.
  const float scale = largest > 1 ? 1.0F : 255.0F;
  const auto byte = [](float value) {
    return value > 0 ? static_cast<std::uint8_t>(std::lround(std::min(value, 255.0F))) : std::uint8_t{0};
  };
  for (const auto& color : obj.colors) {
    const auto c = color.value_or(std::array<float, 4>{255, 255, 255, 1});
    const float alpha = c[3] > 1 ? c[3] : c[3] * 255;
    mesh.colors.push_back({byte(c[0] * scale), byte(c[1] * scale), byte(c[2] * scale), byte(alpha)});
  }
}

void TakeNormals(const ObjData& obj, Mesh& mesh) {
  std::vector<std::int64_t> of_vertex(obj.positions.size(), kAbsent);
  bool any = false;
  for (const auto& triangle : obj.triangles) {
    for (const Corner& corner : triangle) {
      any |= corner.normal != kAbsent;
      if (of_vertex[corner.vertex] == kAbsent) of_vertex[corner.vertex] = corner.normal;
    }
  }
  if (!any) return;
  // With one vn per v, a vertex without a face still has its own.
  const bool paired = obj.normals.size() == obj.positions.size();
  for (std::size_t i = 0; i < of_vertex.size(); ++i) {
    if (of_vertex[i] == kAbsent && paired) of_vertex[i] = static_cast<std::int64_t>(i);
    mesh.normals.push_back(of_vertex[i] == kAbsent ? Vec3f{} : obj.normals[of_vertex[i]]);
  }
}

void TakeTriangles(const ObjData& obj, Mesh& mesh) {
  bool any_uv = false;
  for (const auto& triangle : obj.triangles) {
    for (const Corner& corner : triangle) any_uv |= corner.uv != kAbsent;
  }
  UvTable table;
  for (const auto& triangle : obj.triangles) {
    Triangle vertices{}, uvs{};
    for (int k = 0; k < 3; ++k) {
      vertices[k] = static_cast<std::uint32_t>(triangle[k].vertex);
      if (any_uv) {
        uvs[k] = table.Index(triangle[k].uv == kAbsent ? std::array<float, 2>{} : obj.uvs[triangle[k].uv]);
      }
    }
    mesh.triangles.push_back(vertices);
    if (any_uv) mesh.uv_triangles.push_back(uvs);
  }
  mesh.uvs = table.Take();
}

template <class Number>
void Append(std::string& text, Number value) {
  char digits[32];
  text += ' ';
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

}  // namespace

Status ParseObj(std::string_view text, Mesh& mesh) {
  ObjData obj;
  std::size_t line_count = 0;
  while (!text.empty()) {
    const std::size_t line = line_count + 1;
    std::string_view statement = TakeStatement(text, line_count);
    const std::string_view keyword = TakeWord(statement);
    if (keyword.empty() || keyword.front() == '#') continue;
    obj.words.clear();
    for (auto word = TakeWord(statement); !word.empty() && word.front() != '#'; word = TakeWord(statement)) {
      if (word.back() == '\\') word.remove_suffix(1);
      if (!word.empty()) obj.words.push_back(word);
    }
    if (Status status = ParseStatement(obj, keyword, line); !status.ok()) {
      return Status(status.code(), "line " + std::to_string(line) + ": " + status.message());
    }
  }
  SAC_RETURN_IF_ERROR(CheckIndices(obj));
  mesh = {};
  TakeColors(obj, mesh);
  TakeNormals(obj, mesh);
  TakeTriangles(obj, mesh);
  mesh.positions = std::move(obj.positions);
  return Status::Ok();
}

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

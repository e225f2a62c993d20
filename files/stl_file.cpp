// SPDX-License-Identifier: Apache-2.0
#include "files/stl_file.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "files/byte_order.h"
#include "files/text_scan.h"

namespace sac {
namespace {

constexpr std::size_t kHeaderBytes = 84;    // text, then the number of triangles
constexpr std::size_t kTriangleBytes = 50;  // normal, three corners, two bytes of attributes

Status EndTriangle(PolygonMesh& parsed) {
  for (std::size_t k = 3; k > 0; --k) {
    parsed.faces.vertices.push_back(static_cast<std::uint32_t>(parsed.positions.size() - k));
  }
  return parsed.EndFace();
}

Status ParseBinary(std::string_view bytes, PolygonMesh& parsed) {
  std::uint64_t attributes = 0;
  for (std::size_t at = kHeaderBytes; at < bytes.size(); at += kTriangleBytes) {
    const char* in = bytes.data() + at + 12;
    for (int corner = 0; corner < 3; ++corner) {
      Vec3d position{};
      for (double& x : position) {
        x = LoadLittleFloat(in);
        in += 4;
      }
      parsed.AddPosition(position, [&] {
        return "triangle " + std::to_string(parsed.faces.size()) + ", corner " + std::to_string(corner);
      });
    }
    attributes += in[0] != 0 || in[1] != 0 ? 1 : 0;
    SAC_RETURN_IF_ERROR(EndTriangle(parsed));
  }
  parsed.losses.Count("attribute bytes or colors of triangles", attributes);
  return Status::Ok();
}

Status ParseVertex(std::string_view line, std::size_t line_number, PolygonMesh& parsed) {
  Vec3d position{};
  std::string_view not_finite;
  for (double& x : position) {
    const std::string_view word = TakeWord(line);
    if (!ParseDouble(word, x)) return NotANumber(word);
    if (!std::isfinite(static_cast<float>(x))) not_finite = word;
  }
  parsed.AddPosition(position, [&] {
    return "line " + std::to_string(line_number) + ", triangle " + std::to_string(parsed.faces.size()) + ": " +
           std::string(not_finite);
  });
  return Status::Ok();
}

Status ParseAscii(std::string_view text, PolygonMesh& parsed) {
  std::size_t corner_count = 0, line_number = 0;
  bool ended = false;
  const auto error = [&](const std::string& what) {
    return Status::Corrupt("line " + std::to_string(line_number) + ": " + what);
  };
  while (!text.empty()) {
    std::string_view line = TakeLine(text);
    ++line_number;
    const std::string_view keyword = TakeWord(line);
    if (keyword == "vertex" || keyword == "VERTEX") {
      if (corner_count == 3) return error("a facet of more than three vertices");
      if (const Status status = ParseVertex(line, line_number, parsed); !status.ok()) return error(status.message());
      ++corner_count;
    } else if (keyword == "endfacet" || keyword == "ENDFACET") {
      if (corner_count != 3) return error("a facet of " + std::to_string(corner_count) + " vertices");
      SAC_RETURN_IF_ERROR(EndTriangle(parsed));
      corner_count = 0;
    } else if (keyword == "endsolid" || keyword == "ENDSOLID") {
      ended = true;
      ++parsed.objects;
    } else if (keyword == "facet" || keyword == "FACET") {
      ended = false;
    }
  }
  parsed.wide = true;
  return ended && corner_count == 0 ? Status::Ok() : Status::Corrupt("ends before endsolid");
}

}  // namespace

Status ParseStl(std::string& bytes, PolygonMesh& parsed) {
  parsed = {};
  // An ASCII file may start with any text and a binary one with "solid", so the size decides.
  const std::uint64_t count = bytes.size() < kHeaderBytes ? 0 : LoadLittle32(bytes.data() + kHeaderBytes - 4);
  const std::uint64_t whole = kHeaderBytes + count * kTriangleBytes;
  if (bytes.size() == whole) return ParseBinary(bytes, parsed);
  const std::size_t size = bytes.size();
  SAC_RETURN_IF_ERROR(NormalizeText(bytes));
  std::string_view start = std::string_view(bytes).substr(0, kHeaderBytes);
  const std::string_view first = TakeWord(start);
  if (first == "solid" || first == "SOLID") return ParseAscii(bytes, parsed);
  return Status::Corrupt("neither ASCII STL nor binary STL of " + std::to_string(count) + " triangles, which takes " +
                         std::to_string(whole) + " bytes and not " + std::to_string(size));
}

}  // namespace sac

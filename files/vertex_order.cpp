// SPDX-License-Identifier: Apache-2.0
#include "files/vertex_order.h"

#include <string_view>

#include "files/stream_input.h"
#include "files/text_scan.h"
#include "geometry/in_input_order.h"

namespace sac {
Positions ToInputOrder(const Positions& decoded, const VertexOrder& order) { return InInputOrder(decoded, order); }

Mesh ToInputOrder(const Mesh& decoded, const VertexOrder& order) {
  Mesh mesh = decoded;
  mesh.positions = InInputOrder(decoded.positions, order);
  if (decoded.normal_triangles.empty()) mesh.normals = InInputOrder(decoded.normals, order);
  mesh.colors = InInputOrder(decoded.colors, order);
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& vertex : triangle) vertex = order[vertex];
  }
  return mesh;
}

std::string FormatOrderMap(const VertexOrder& order) {
  std::string text = "# sac order map, " + std::to_string(order.size()) + " vertices\n";
  for (const std::uint32_t index : order) text += std::to_string(index) + '\n';
  return text;
}

Status ReadOrderMap(const std::string& path, std::size_t vertices, VertexOrder& order) {
  std::string text;
  // An index takes up to 10 digits and a line end; the rest is for comments.
  SAC_RETURN_IF_ERROR(ReadToEnd(path, text, 16 * vertices + (1 << 20), "too large for an order map of this clip"));
  std::string_view rest = text;
  std::vector<bool> seen(vertices);
  order.clear();
  for (std::size_t line = 1; !rest.empty(); ++line) {
    std::string_view words = TakeLine(rest);
    const std::string_view word = TakeWord(words);
    if (word.empty() || word.front() == '#') continue;
    const std::string where = path + ":" + std::to_string(line) + ": ";
    std::int64_t index = 0;
    if (!ParseInteger(word, index) || !TakeWord(words).empty()) return Status::Corrupt(where + "not an index");
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertices) {
      return Status::Corrupt(where + "index " + std::string(word) + ", but the clip has " + std::to_string(vertices) +
                             " vertices");
    }
    if (seen[static_cast<std::size_t>(index)]) {
      return Status::Corrupt(where + "index " + std::string(word) + " for the second time");
    }
    seen[static_cast<std::size_t>(index)] = true;
    order.push_back(static_cast<std::uint32_t>(index));
  }
  if (order.size() == vertices) return Status::Ok();
  return Status::Corrupt(path + ": " + std::to_string(order.size()) + " indices, but the clip has " +
                         std::to_string(vertices) + " vertices");
}

}  // namespace sac

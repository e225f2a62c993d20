// SPDX-License-Identifier: Apache-2.0
#include "files/moved_positions.h"

#include <bit>
#include <charconv>
#include <cstddef>
#include <cstring>

#include "files/clip_offset.h"
#include "files/text_scan.h"

namespace sac {
namespace {

static_assert(std::endian::native == std::endian::little, "doubles are written as they are in memory");

void AppendLine(std::string& text, std::string_view line) { text.append(line).append(1, '\n'); }

}  // namespace

std::string MoveOff(std::string_view text, const Positions& positions, const std::array<double, 3>& offset) {
  std::string moved;
  for (int line = 0; line < 2; ++line) AppendLine(moved, TakeLine(text));  // the format, the counts
  for (const Vec3f& position : positions) {
    std::string_view line = TakeLine(text);
    for (const double x : Absolute(offset, position)) {
      char digits[32];
      (void)TakeWord(line);
      moved.append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr).append(1, ' ');
    }
    AppendLine(moved, line);
  }
  return moved.append(text);
}

std::string MovePly(std::string_view bytes, const Positions& positions, const std::array<double, 3>& offset) {
  constexpr std::size_t kOld = 12;  // bytes of x, y and z
  std::string moved;
  std::size_t rest = 0;  // bytes of a vertex after these
  bool of_vertices = false;
  for (bool in_header = true; in_header && !bytes.empty();) {
    const std::string_view line = TakeLine(bytes);
    std::string_view words = line;
    const std::string_view keyword = TakeWord(words), type = TakeWord(words), name = TakeWord(words);
    in_header = keyword != "end_header";
    if (keyword == "element") of_vertices = type == "vertex";
    const bool is_property = keyword == "property" && of_vertices;
    const bool moves = is_property && (name == "x" || name == "y" || name == "z");
    if (is_property && !moves) rest += type == "float" ? 4 : 1;
    AppendLine(moved, moves ? "property double " + std::string(name) : std::string(line));
  }
  for (const Vec3f& position : positions) {
    const Vec3d sum = Absolute(offset, position);
    moved.append(reinterpret_cast<const char*>(sum.data()), sizeof sum).append(bytes.substr(kOld, rest));
    bytes.remove_prefix(kOld + rest);
  }
  return moved.append(bytes);
}

}  // namespace sac

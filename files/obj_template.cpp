// SPDX-License-Identifier: Apache-2.0
#include "files/obj_template.h"

#include <array>
#include <cassert>
#include <charconv>
#include <string_view>
#include <utility>

#include "files/obj_file.h"
#include "files/text_scan.h"

namespace sac {
namespace {

template <class Number>
void AppendNumber(Number value, std::string& text) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

}  // namespace

Status ObjTemplate::Parse(std::string text, ObjTemplate& obj) {
  obj = {};
  obj.text_ = std::move(text);
  std::size_t line = 0;
  std::array<std::string_view, 3> words;
  for (std::string_view rest = obj.text_; !rest.empty();) {
    const std::size_t first_line = line + 1;
    std::string_view statement = TakeObjStatement(rest, line);
    const std::string_view keyword = TakeWord(statement);
    if (keyword != "v" && keyword != "vn") continue;
    for (std::string_view& word : words) {
      do {
        word = TakeWord(statement);
      } while (word == "\\");  // which continues the line
      if (!word.empty() && word.back() == '\\') word.remove_suffix(1);
      if (word.empty()) return Status::Corrupt("line " + std::to_string(first_line) + ": fewer than three numbers");
    }
    Place& place = obj.places_.emplace_back();
    place.begin = static_cast<std::size_t>(words[0].data() - obj.text_.data());
    place.end = static_cast<std::size_t>(words[2].data() + words[2].size() - obj.text_.data());
    place.normal = keyword == "vn";
    if (!place.normal) {
      ++obj.vertices_;
      continue;
    }
    Vec3f& normal = obj.normals_.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) {
      if (!ParseFloat(words[a], normal[a])) return NotANumber(words[a]);
    }
  }
  return Status::Ok();
}

void ObjTemplate::ReplaceNormals(std::vector<Vec3f> normals) {
  assert(normals.size() == normals_.size());
  normals_ = std::move(normals);
  replaced_ = true;
}

std::string ObjTemplate::Format(const Positions& positions, const std::array<double, 3>& offset) const {
  std::string text;
  text.reserve(text_.size() + 8 * places_.size());
  std::size_t done = 0, vertex = 0, normal = 0;
  for (const Place& place : places_) {
    if (place.normal && !replaced_) continue;
    text.append(text_, done, place.begin - done);
    const Vec3f& value = place.normal ? normals_[normal++] : positions[vertex++];
    for (std::size_t a = 0; a < 3; ++a) {
      if (a > 0) text += ' ';
      if (place.normal || offset[a] == 0) {
        AppendNumber(value[a], text);
      } else {
        AppendNumber(offset[a] + static_cast<double>(value[a]), text);
      }
    }
    done = place.end;
  }
  return text.append(text_, done);
}

}  // namespace sac

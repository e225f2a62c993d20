// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "files/obj_file.h"
#include "files/text_scan.h"

namespace sac {
namespace {

constexpr std::uint32_t kNone = PolygonMesh::kNone;
constexpr std::array<float, 4> kNoColor = {0, 0, 0, -1};  // as RoundColors takes it

// A statement that a Mesh has no place for: told by the names that follow it, or by their number.
struct Unkept {
  std::string_view keyword;
  const char* what;
  bool by_name;
};

constexpr Unkept kUnkept[] = {
    {"g", "groups", true},
    {"usemtl", "materials", true},
    {"mtllib", "material libraries", true},
    {"usemap", "texture maps", true},
    {"maplib", "texture maps", true},
    {"mg", "merging groups", true},
    {"l", "lines", false},
    {"p", "points", false},
    {"vp", "free-form statements", false},
    {"cstype", "free-form statements", false},
    {"deg", "free-form statements", false},
    {"bmat", "free-form statements", false},
    {"step", "free-form statements", false},
    {"curv", "free-form statements", false},
    {"curv2", "free-form statements", false},
    {"surf", "free-form statements", false},
    {"parm", "free-form statements", false},
    {"trim", "free-form statements", false},
    {"hole", "free-form statements", false},
    {"scrv", "free-form statements", false},
    {"sp", "free-form statements", false},
    {"con", "free-form statements", false},
    {"end", "free-form statements", false},
};

class ObjParser {
 public:
  explicit ObjParser(PolygonMesh& parsed) : mesh_(parsed) {}

  Status ParseStatement(std::string_view keyword, std::string_view rest, std::size_t line);
  Status Finish();

 private:
  // The numbers of the statement at hand: at least `least`, at most seven.
  Status ParseNumbers(std::size_t least, std::array<double, 7>& values, std::size_t& count) const;
  Status ParseVertex(std::size_t line);
  Status ParseIndex(std::string_view word, std::size_t count, std::uint32_t& index) const;
  Status ParseFace(std::size_t line);
  Status CheckIndices() const;
  void CountOther(std::string_view keyword, std::string_view rest);

  PolygonMesh& mesh_;
  std::vector<std::array<float, 4>> colors_;  // empty, or one per vertex
  std::uint64_t colored_ = 0;                 // vertices that have one
  std::vector<std::size_t> face_lines_;
  std::vector<std::string_view> words_;  // of the statement at hand, without its keyword
};

Status ObjParser::ParseNumbers(std::size_t least, std::array<double, 7>& values, std::size_t& count) const {
  if (words_.size() < least) return Status::Corrupt("expected " + std::to_string(least) + " numbers");
  count = std::min(words_.size(), values.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (!ParseDouble(words_[i], values[i])) return NotANumber(words_[i]);
  }
  return Status::Ok();
}

Status ObjParser::ParseVertex(std::size_t line) {
  std::array<double, 7> x{};
  std::size_t count = 0;
  SAC_RETURN_IF_ERROR(ParseNumbers(3, x, count));
  const std::size_t vertex = mesh_.positions.size();
  mesh_.AddPosition({x[0], x[1], x[2]}, [&] {
    const auto wrong = std::find_if(x.begin(), x.begin() + 2, [](double v) { return !std::isfinite(float(v)); });
    return "line " + std::to_string(line) + ", vertex " + std::to_string(vertex) + ": " +
           std::string(words_[static_cast<std::size_t>(wrong - x.begin())]);
  });
  if (count >= 6) {
    colors_.resize(vertex, kNoColor);
    colors_.push_back({static_cast<float>(x[3]), static_cast<float>(x[4]), static_cast<float>(x[5]),
                       count == 7 ? static_cast<float>(x[6]) : 1.0F});
    ++colored_;
  } else if (!colors_.empty()) {
    colors_.push_back(kNoColor);
  }
  mesh_.losses.Count("weights of vertices", (count == 4 || count == 5) && x[3] != 1 ? 1 : 0);
  return Status::Ok();
}

// OBJ counts from 1, or with negative numbers back from the last element so far.
Status ObjParser::ParseIndex(std::string_view word, std::size_t count, std::uint32_t& index) const {
  std::int64_t value = 0;
  if (!ParseInteger(word, value)) return Status::Corrupt("not an index: " + std::string(word));
  const std::int64_t from_zero = value > 0 ? value - 1 : static_cast<std::int64_t>(count) + value;
  if (value == 0 || from_zero < 0 || from_zero >= kNone) {
    return Status::Corrupt("index out of range: " + std::string(word));
  }
  index = static_cast<std::uint32_t>(from_zero);
  return Status::Ok();
}

Status ObjParser::ParseFace(std::size_t line) {
  const std::size_t counts[] = {mesh_.positions.size(), mesh_.uvs.size(), mesh_.normals.size()};
  for (std::string_view word : words_) {
    std::uint32_t indices[3] = {kNone, kNone, kNone};
    for (int i = 0; true; ++i) {
      if (i == 3) return Status::Corrupt("a corner of more than three indices");
      const std::size_t end = word.find('/');
      if (const std::string_view part = word.substr(0, end); i == 0 || !part.empty()) {
        SAC_RETURN_IF_ERROR(ParseIndex(part, counts[i], indices[i]));
      }
      if (end == std::string_view::npos) break;
      word.remove_prefix(end + 1);
    }
    mesh_.faces.vertices.push_back(indices[0]);
    mesh_.corner_uvs.push_back(indices[1]);
    mesh_.corner_normals.push_back(indices[2]);
  }
  face_lines_.push_back(line);
  return mesh_.EndFace();
}

void ObjParser::CountOther(std::string_view keyword, std::string_view rest) {
  const std::string_view first = words_.empty() ? std::string_view() : words_[0];
  if (keyword == "o") {
    ++mesh_.objects;
    mesh_.losses.Name("object names", rest);
  } else if (keyword == "s") {
    if (first != "off" && first != "0") mesh_.losses.Name("smoothing groups", first);
  } else if (const auto* known = std::find_if(std::begin(kUnkept), std::end(kUnkept),
                                              [&](const Unkept& unkept) { return unkept.keyword == keyword; });
             known == std::end(kUnkept)) {
    mesh_.losses.List("statements", keyword);
  } else if (known->by_name) {
    mesh_.losses.Name(known->what, rest);
  } else {
    mesh_.losses.Count(known->what);
  }
}

Status ObjParser::ParseStatement(std::string_view keyword, std::string_view rest, std::size_t line) {
  words_.clear();
  while (!rest.empty() && IsBlank(rest.front())) rest.remove_prefix(1);
  while (!rest.empty() && IsBlank(rest.back())) rest.remove_suffix(1);
  std::string_view left = rest;
  for (auto word = TakeWord(left); !word.empty() && word.front() != '#'; word = TakeWord(left)) {
    if (word.back() == '\\') word.remove_suffix(1);
    if (!word.empty()) words_.push_back(word);
  }
  std::array<double, 7> x{};
  std::size_t count = 0;
  if (keyword == "v") return ParseVertex(line);
  if (keyword == "f" || keyword == "fo") return ParseFace(line);
  if (keyword == "vt") {
    SAC_RETURN_IF_ERROR(ParseNumbers(1, x, count));
    mesh_.uvs.push_back({static_cast<float>(x[0]), static_cast<float>(x[1])});
    mesh_.losses.Count("third texture coordinates", count > 2 && x[2] != 0 ? 1 : 0);
  } else if (keyword == "vn") {
    SAC_RETURN_IF_ERROR(ParseNumbers(3, x, count));
    mesh_.normals.push_back({static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])});
  } else {
    CountOther(keyword, rest);
  }
  return Status::Ok();
}

// Only at the end, because a face may name vertices that follow it.
Status ObjParser::CheckIndices() const {
  const Faces& faces = mesh_.faces;
  for (std::size_t face = 0; face < faces.size(); ++face) {
    for (std::uint32_t k = faces.begin(face); k < faces.ends[face]; ++k) {
      const auto check = [&](const char* what, std::uint32_t index, std::size_t count) {
        if (index == kNone || index < count) return Status::Ok();
        return Status::Corrupt("line " + std::to_string(face_lines_[face]) + ": " + what + " " +
                               std::to_string(std::uint64_t{index} + 1) + ", but there are " + std::to_string(count));
      };
      SAC_RETURN_IF_ERROR(check("vertex", faces.vertices[k], mesh_.positions.size()));
      SAC_RETURN_IF_ERROR(check("texture vertex", mesh_.corner_uvs[k], mesh_.uvs.size()));
      SAC_RETURN_IF_ERROR(check("normal", mesh_.corner_normals[k], mesh_.normals.size()));
    }
  }
  return Status::Ok();
}

Status ObjParser::Finish() {
  SAC_RETURN_IF_ERROR(CheckIndices());
  const auto unused = [](const std::vector<std::uint32_t>& corners) {
    return std::all_of(corners.begin(), corners.end(), [](std::uint32_t index) { return index == kNone; });
  };
  if (unused(mesh_.corner_uvs)) {
    mesh_.losses.Count("texture coordinates that no face uses", mesh_.uvs.size());
    mesh_.corner_uvs.clear();
  }
  if (unused(mesh_.corner_normals)) {
    mesh_.losses.Count("normals that no face uses", mesh_.normals.size());
    mesh_.normals.clear();
    mesh_.corner_normals.clear();
  }
  if (colored_ > 0 && colored_ < mesh_.positions.size()) {
    mesh_.warnings.push_back("colors are missing on " + std::to_string(mesh_.positions.size() - colored_) + " of " +
                             std::to_string(mesh_.positions.size()) + " vertices; those become white");
  }
  mesh_.colors = RoundColors(colors_, mesh_.losses);
  mesh_.wide = true;
  return Status::Ok();
}

}  // namespace

// A comment may end in a backslash, too (a path, say).
std::string_view TakeObjStatement(std::string_view& text, std::size_t& line_count) {
  const char* begin = text.data();
  std::string_view line;
  do {
    line = TakeLine(text);
    ++line_count;
  } while (!line.empty() && line.back() == '\\' && *begin != '#' && !text.empty());
  return {begin, static_cast<std::size_t>(line.data() + line.size() - begin)};
}

Status ParseObj(std::string_view text, PolygonMesh& parsed) {
  parsed = {};
  ObjParser parser(parsed);
  std::size_t line_count = 0;
  while (!text.empty()) {
    const std::size_t line = line_count + 1;
    std::string_view statement = TakeObjStatement(text, line_count);
    const std::string_view keyword = TakeWord(statement);
    if (keyword.empty() || keyword.front() == '#') continue;
    if (Status status = parser.ParseStatement(keyword, statement, line); !status.ok()) {
      return Status(status.code(), "line " + std::to_string(line) + ": " + status.message());
    }
  }
  return parser.Finish();
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "files/off_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "files/text_scan.h"

namespace sac {
namespace {

constexpr std::size_t kMostColors = 4;

class OffParser {
 public:
  OffParser(std::string_view text, PolygonMesh& parsed) : text_(text), rest_(text), mesh_(parsed) {}

  Status Parse() {
    const Status status = ParseAll();
    if (status.ok() || where_.data() == nullptr) return status;
    const std::size_t line = LineNumber(text_, static_cast<std::size_t>(where_.data() - text_.data()));
    return Status(status.code(), "line " + std::to_string(line) + ": " + status.message());
  }

 private:
  Status ParseAll();
  Status ParseHeader();
  Status ParseVertex();
  Status ParseFace();
  void TakeColor(std::size_t vertex);

  // The next word, over the ends of lines and comments; empty at the end of the file.
  std::string_view TakeWordOfFile();
  Status TakeNumber(double& value);
  Status TakeCount(std::uint64_t& count);
  // The words left of the line at hand, in words_.
  void TakeRestOfLine();

  std::string_view text_, rest_, line_;
  std::string_view where_;  // the word taken last
  PolygonMesh& mesh_;
  bool has_uvs_ = false, has_colors_ = false, has_normals_ = false;
  bool real_colors_ = false;  // one of the colours has a point
  std::vector<std::string_view> words_;
  std::vector<std::array<float, 2>> vertex_uvs_;
  std::vector<std::array<float, 4>> colors_;
};

std::string_view OffParser::TakeWordOfFile() {
  while (true) {
    const std::string_view word = TakeWord(line_);
    if (!word.empty()) {
      where_ = word;
      return word;
    }
    if (rest_.empty()) return {};
    line_ = TakeLine(rest_);
    line_ = line_.substr(0, line_.find('#'));
  }
}

Status OffParser::TakeNumber(double& value) {
  const std::string_view word = TakeWordOfFile();
  if (word.empty()) return Status::Corrupt("the file ends here");
  return ParseDouble(word, value) ? Status::Ok() : NotANumber(word);
}

// A vertex or a face takes a byte at least, which bounds what the counts can be.
Status OffParser::TakeCount(std::uint64_t& count) {
  const std::string_view word = TakeWordOfFile();
  if (word.empty()) return Status::Corrupt("the file ends here");
  std::int64_t value = 0;
  if (!ParseInteger(word, value) || value < 0 || static_cast<std::uint64_t>(value) > text_.size()) {
    return Status::Corrupt("cannot have the count " + std::string(word.substr(0, 40)) + " in " +
                           std::to_string(text_.size()) + " bytes");
  }
  count = static_cast<std::uint64_t>(value);
  return Status::Ok();
}

void OffParser::TakeRestOfLine() {
  words_.clear();
  for (auto word = TakeWord(line_); !word.empty(); word = TakeWord(line_)) words_.push_back(word);
}

Status OffParser::ParseHeader() {
  std::string_view keyword = TakeWordOfFile();
  const auto take = [&keyword](std::string_view prefix) {
    const bool has = keyword.substr(0, prefix.size()) == prefix;
    if (has) keyword.remove_prefix(prefix.size());
    return has;
  };
  if (keyword.find("OFF") > 5) return Status::Corrupt("not an OFF file");
  has_uvs_ = take("ST");
  has_colors_ = take("C");
  has_normals_ = take("N");
  if (take("4") || take("n")) return Status::Unsupported("not an OFF file of three dimensions");
  if (keyword != "OFF") return Status::Corrupt("not an OFF file");
  std::string_view after = line_;
  if (TakeWord(after) == "BINARY") return Status::Unsupported("binary OFF; write OFF as text");
  return Status::Ok();
}

// Of the words that follow position and normal, those before the texture coordinates are the colour.
void OffParser::TakeColor(std::size_t vertex) {
  if (!has_colors_ || words_.size() < 3) return;
  std::array<float, 4> color = {0, 0, 0, -1};
  const std::size_t count = std::min(words_.size(), kMostColors);
  bool real = false;
  for (std::size_t k = 0; k < count; ++k) {
    if (!ParseFloat(words_[k], color[k])) return;
    real |= words_[k].find_first_of(".eE") != std::string_view::npos;
  }
  if (count == 3) color[3] = real ? 1.0F : 255.0F;
  color[3] = std::max(color[3], 0.0F);
  real_colors_ |= real;
  colors_.resize(vertex, {0, 0, 0, -1});
  colors_.push_back(color);
}

Status OffParser::ParseVertex() {
  const std::size_t vertex = mesh_.positions.size();
  Vec3d position{};
  std::string_view not_finite;
  for (double& x : position) {
    SAC_RETURN_IF_ERROR(TakeNumber(x));
    if (!std::isfinite(static_cast<float>(x))) not_finite = where_;
  }
  mesh_.AddPosition(position, [&] {
    const auto at = static_cast<std::size_t>(not_finite.data() - text_.data());
    return "line " + std::to_string(LineNumber(text_, at)) + ", vertex " + std::to_string(vertex) + ": " +
           std::string(not_finite);
  });
  if (has_normals_) {
    double normal[3] = {};
    for (double& x : normal) SAC_RETURN_IF_ERROR(TakeNumber(x));
    mesh_.normals.push_back(
        {static_cast<float>(normal[0]), static_cast<float>(normal[1]), static_cast<float>(normal[2])});
  }
  TakeRestOfLine();
  if (has_uvs_) {
    std::array<float, 2> uv{};
    if (words_.size() < 2) return Status::Corrupt("a vertex without its texture coordinates");
    for (std::size_t k = 0; k < 2; ++k) {
      const std::string_view word = words_[words_.size() - 2 + k];
      if (!ParseFloat(word, uv[k])) return NotANumber(word);
    }
    vertex_uvs_.push_back(uv);
    words_.resize(words_.size() - 2);
  }
  TakeColor(vertex);
  const std::size_t known = has_colors_ ? kMostColors : 0;
  mesh_.losses.Count("vertices with further numbers", words_.size() > known ? 1 : 0);
  return Status::Ok();
}

Status OffParser::ParseFace() {
  std::uint64_t corners = 0;
  SAC_RETURN_IF_ERROR(TakeCount(corners));
  for (std::uint64_t k = 0; k < corners; ++k) {
    const std::string_view word = TakeWordOfFile();
    std::int64_t index = 0;
    if (word.empty()) return Status::Corrupt("the file ends here");
    if (!ParseInteger(word, index)) return Status::Corrupt("not an index: " + std::string(word.substr(0, 40)));
    if (index < 0 || static_cast<std::uint64_t>(index) >= mesh_.positions.size()) {
      return Status::Corrupt("vertex " + std::string(word) + ", but there are " +
                             std::to_string(mesh_.positions.size()));
    }
    mesh_.faces.vertices.push_back(static_cast<std::uint32_t>(index));
  }
  TakeRestOfLine();
  mesh_.losses.Count("colors of faces", words_.empty() ? 0 : 1);
  return mesh_.EndFace();
}

Status OffParser::ParseAll() {
  SAC_RETURN_IF_ERROR(ParseHeader());
  std::uint64_t vertices = 0, faces = 0;
  SAC_RETURN_IF_ERROR(TakeCount(vertices));
  SAC_RETURN_IF_ERROR(TakeCount(faces));
  // Edges are counted by many writers as 0, and left out by some.
  TakeRestOfLine();
  for (std::uint64_t v = 0; v < vertices; ++v) {
    if (const Status status = ParseVertex(); !status.ok()) {
      return Status(status.code(), "vertex " + std::to_string(v) + ": " + status.message());
    }
  }
  for (std::uint64_t f = 0; f < faces; ++f) {
    if (const Status status = ParseFace(); !status.ok()) {
      return Status(status.code(), "face " + std::to_string(f) + ": " + status.message());
    }
  }
  if (!vertex_uvs_.empty()) {
    mesh_.corner_uvs = mesh_.faces.vertices;
    mesh_.uvs = std::move(vertex_uvs_);
  }
  if (!colors_.empty()) {
    colors_.resize(mesh_.positions.size(), {0, 0, 0, -1});
    for (auto& color : colors_) {
      for (float& c : color) c = real_colors_ || c < 0 ? c : c / 255;
    }
    mesh_.colors = RoundColors(colors_, mesh_.losses);
  }
  mesh_.wide = true;
  return Status::Ok();
}

}  // namespace

Status ParseOff(std::string_view text, PolygonMesh& parsed) {
  parsed = {};
  return OffParser(text, parsed).Parse();
}

}  // namespace sac

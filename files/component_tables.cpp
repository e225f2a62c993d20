// SPDX-License-Identifier: Apache-2.0
#include "files/component_tables.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <span>
#include <string_view>

#include "files/stream_input.h"
#include "files/text_scan.h"

namespace sac {
namespace {

constexpr std::size_t kMostText = std::size_t{1} << 30;  // bytes

Status ReadText(const std::string& path, std::string& text) {
  SAC_RETURN_IF_ERROR(ReadToEnd(path, text, kMostText, "larger than 1 GB"));
  const Status status = NormalizeText(text);
  return status.ok() ? status : Status(status.code(), path + ": " + status.message());
}

std::string Shortest(float x) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x);
  return {text.data(), end.ptr};
}

// Fields of a line of comma-separated values; a quoted one may hold commas and doubled quotes.
std::vector<std::string> Fields(std::string_view line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"')
        fields.back() += line[i++];
      else
        quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return fields;
}

std::string QuotedField(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' ? ' ' : c);
  return out + '"';
}

// A vertex and three coordinates or none.
struct VertexLine {
  std::uint32_t vertex;
  bool has_vector;
  Vec3f vector;
};

Status ReadVertexLines(const std::string& path, std::vector<VertexLine>& lines) {
  std::string text;
  SAC_RETURN_IF_ERROR(ReadText(path, text));
  std::string_view rest = text;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    std::string_view words = TakeLine(rest);
    words = words.substr(0, words.find('#'));
    std::string_view word = TakeWord(words);
    if (word.empty()) continue;
    const std::string where = path + ":" + std::to_string(number) + ": ";
    std::int64_t index = 0;
    if (!ParseInteger(word, index) || index < 0 || index > std::numeric_limits<std::uint32_t>::max()) {
      return Status::Corrupt(where + "'" + std::string(word) + "' is no index of a vertex");
    }
    VertexLine line{static_cast<std::uint32_t>(index), false, {}};
    for (std::size_t a = 0; !(word = TakeWord(words)).empty(); ++a) {
      if (a == 3) return Status::Corrupt(where + "more than a vertex and three numbers");
      if (!ParseFloat(word, line.vector[a]) || !std::isfinite(line.vector[a])) {
        return Status::Corrupt(where + "'" + std::string(word) + "' is no finite number");
      }
      line.has_vector = a == 2;
      if (a < 2 && std::all_of(words.begin(), words.end(), IsBlank)) {
        return Status::Corrupt(where + "a vertex has three numbers or none");
      }
    }
    lines.push_back(line);
  }
  if (lines.empty()) return Status::Corrupt(path + ": names no vertex");
  return Status::Ok();
}

}  // namespace

std::string FormatWeights(const SparseComponents& components) {
  std::string text = "frame";
  for (const SparseComponent& c : components.components) text += ',' + QuotedField(c.name);
  text += '\n';
  for (std::size_t f = 0; f < components.frames(); ++f) {
    text += std::to_string(f);
    for (std::size_t k = 0; k < components.components.size(); ++k) text += ',' + Shortest(components.weight(f, k));
    text += '\n';
  }
  return text;
}

Status ReadWeights(const std::string& path, std::size_t count, std::vector<float>& weights) {
  std::string text;
  SAC_RETURN_IF_ERROR(ReadText(path, text));
  std::string_view rest = text;
  weights.clear();
  bool skips_first = false, begun = false;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    std::string_view line = TakeLine(rest);
    if (std::all_of(line.begin(), line.end(), IsBlank)) continue;
    std::vector<std::string> fields = Fields(line);
    float ignored = 0;
    std::string_view first = fields[0];
    if (!begun && !ParseFloat(TakeWord(first), ignored)) {
      skips_first = fields[0] == "frame";
      begun = true;
      continue;
    }
    begun = true;
    if (skips_first) fields.erase(fields.begin());
    const std::string where = path + ":" + std::to_string(number) + ": ";
    if (fields.size() != count) {
      return Status::Corrupt(where + std::to_string(fields.size()) + " weights for " + std::to_string(count) +
                             " components");
    }
    for (const std::string& field : fields) {
      std::string_view words = field;
      float w = 0;
      if (!ParseFloat(TakeWord(words), w) || !std::isfinite(w)) {
        return Status::Corrupt(where + "'" + field + "' is no finite number");
      }
      weights.push_back(w);
    }
  }
  if (weights.empty()) return Status::Corrupt(path + ": holds no weights");
  return Status::Ok();
}

Status ReadStroke(const std::string& path, Stroke& stroke) {
  std::vector<VertexLine> lines;
  SAC_RETURN_IF_ERROR(ReadVertexLines(path, lines));
  stroke = {};
  stroke.name = std::filesystem::path(path).stem().string();
  for (const VertexLine& line : lines) {
    if (line.has_vector != lines.front().has_vector) {
      return Status::Corrupt(path + ": some vertices have a displacement, others have none");
    }
    stroke.vertices.push_back(line.vertex);
    if (line.has_vector) stroke.displacements.push_back(line.vector);
  }
  return Status::Ok();
}

Status ReadDrag(const std::string& path, std::vector<DragTarget>& targets) {
  std::vector<VertexLine> lines;
  SAC_RETURN_IF_ERROR(ReadVertexLines(path, lines));
  targets.clear();
  for (const VertexLine& line : lines) {
    if (!line.has_vector) {
      return Status::Corrupt(path + ": vertex " + std::to_string(line.vertex) + " has no position");
    }
    targets.push_back({line.vertex, line.vector});
  }
  return Status::Ok();
}

}  // namespace sac

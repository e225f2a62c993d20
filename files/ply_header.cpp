// SPDX-License-Identifier: Apache-2.0
#include "files/ply_header.h"

#include <algorithm>

#include "files/text_scan.h"

namespace sac {
namespace {

struct TypeName {
  std::string_view name;
  PlyType type;
};

// The names of the first description of the format, and those that tell the size.
constexpr TypeName kTypeNames[] = {
    {"char", PlyType::kInt8},       {"int8", PlyType::kInt8},       {"uchar", PlyType::kUint8},
    {"uint8", PlyType::kUint8},     {"short", PlyType::kInt16},     {"int16", PlyType::kInt16},
    {"ushort", PlyType::kUint16},   {"uint16", PlyType::kUint16},   {"int", PlyType::kInt32},
    {"int32", PlyType::kInt32},     {"uint", PlyType::kUint32},     {"uint32", PlyType::kUint32},
    {"float", PlyType::kFloat32},   {"float32", PlyType::kFloat32}, {"double", PlyType::kFloat64},
    {"float64", PlyType::kFloat64},
};

Status ParseType(std::string_view name, PlyType& type) {
  const auto* found = std::find_if(std::begin(kTypeNames), std::end(kTypeNames),
                                   [name](const TypeName& known) { return known.name == name; });
  if (found == std::end(kTypeNames)) return Status::Unsupported("header: type " + std::string(name));
  type = found->type;
  return Status::Ok();
}

Status ParseFormat(std::string_view name, PlyHeader& header) {
  if (name == "ascii") {
    header.format = PlyHeader::Format::kAscii;
  } else if (name == "binary_little_endian") {
    header.format = PlyHeader::Format::kLittleEndian;
  } else if (name == "binary_big_endian") {
    header.format = PlyHeader::Format::kBigEndian;
  } else {
    return Status::Unsupported("header: format " + std::string(name));
  }
  return Status::Ok();
}

Status ParseProperty(const std::vector<std::string_view>& words, PlyProperty& property) {
  property.name = words.back();
  if (words.size() == 3) return ParseType(words[1], property.type);
  SAC_RETURN_IF_ERROR(ParseType(words[2], property.count.emplace()));
  if (!IsPlyInteger(*property.count)) return Status::Corrupt("header: the list " + property.name + " has no length");
  return ParseType(words[3], property.type);
}

// One line of the header after the first, as words.
Status ParseHeaderLine(const std::vector<std::string_view>& words, std::size_t file_size, PlyHeader& header) {
  if (words[0] == "format" && words.size() == 3) return ParseFormat(words[1], header);
  if (words[0] == "element" && words.size() == 3) {
    PlyElement& element = header.elements.emplace_back();
    element.name = words[1];
    std::int64_t count = 0;
    if (!ParseInteger(words[2], count) || count < 0 || static_cast<std::uint64_t>(count) > file_size) {
      return Status::Corrupt("header: " + std::string(words[2]) + " elements of type " + element.name + " in " +
                             std::to_string(file_size) + " bytes");
    }
    element.count = static_cast<std::uint64_t>(count);
    return Status::Ok();
  }
  const bool list = words.size() == 5 && words[1] == "list";
  if (words[0] == "property" && (words.size() == 3 || list) && !header.elements.empty()) {
    return ParseProperty(words, header.elements.back().properties.emplace_back());
  }
  return Status::Corrupt("header: cannot read the line that starts with " + std::string(words[0].substr(0, 40)));
}

// Takes lines that end in LF, CR or CRLF. Where the first ends in CR alone, so do all: an LF after the CR of end_header
// is data then.
class HeaderLines {
 public:
  explicit HeaderLines(std::string_view bytes) : bytes_(bytes) {}

  bool Take(std::string_view& line) {
    const std::size_t end = bytes_.find_first_of("\r\n", at_);
    if (end == std::string_view::npos) return false;
    line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    const bool lf_follows = bytes_[end] == '\r' && bytes_.substr(at_, 1) == "\n";
    if (lf_follows && !only_cr_) ++at_;
    // The first line decides.
    if (first_) only_cr_ = bytes_[end] == '\r' && !lf_follows;
    first_ = false;
    return true;
  }

  std::size_t taken() const { return at_; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool first_ = true, only_cr_ = false;
};

}  // namespace

std::size_t PlyBytes(PlyType type) {
  constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

Status ParsePlyHeader(std::string_view bytes, PlyHeader& header) {
  header = {};
  HeaderLines lines(bytes);
  std::string_view line;
  const bool has_line = lines.Take(line);
  const std::string_view magic = TakeWord(line);
  if (!has_line || (magic != "ply" && magic != "PLY")) return Status::Corrupt("not a PLY file");
  bool has_format = false;
  std::vector<std::string_view> words;
  while (true) {
    if (!lines.Take(line)) return Status::Corrupt("header: ends before end_header");
    words.clear();
    for (auto word = TakeWord(line); !word.empty(); word = TakeWord(line)) words.push_back(word);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    SAC_RETURN_IF_ERROR(ParseHeaderLine(words, bytes.size(), header));
    has_format |= words[0] == "format";
  }
  if (!has_format) return Status::Corrupt("header: no format");
  header.size = lines.taken();
  return Status::Ok();
}

}  // namespace sac

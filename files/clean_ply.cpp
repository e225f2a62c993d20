// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "files/openmesh_input.h"
#include "files/text_scan.h"

namespace sac {
namespace {

bool IsFloat(std::string_view type) {
  return type == "float" || type == "float32" || type == "double" || type == "float64";
}

bool IsInteger(std::string_view type) {
  static const std::set<std::string_view> kTypes = {"char",   "int8",   "uchar", "uint8", "short", "int16",
                                                    "ushort", "uint16", "int",   "int32", "uint",  "uint32"};
  return kTypes.count(type) != 0;
}

// The name under which OpenMesh reads a vertex property, or one that it skips.
std::string VertexPropertyName(std::string_view name, std::string_view type) {
  static const std::set<std::string_view> kReal = {"x", "y", "z", "nx", "ny", "nz", "u", "v", "s", "t"};
  static const std::set<std::string_view> kColor = {"red",         "green",         "blue",        "alpha",
                                                    "diffuse_red", "diffuse_green", "diffuse_blue"};
  if (name == "texture_u") name = "u";
  if (name == "texture_v") name = "v";
  if (kReal.count(name) != 0 && IsFloat(type)) return std::string(name);
  if (kColor.count(name) != 0 && (type == "uchar" || type == "uint8" || type == "float" || type == "float32")) {
    return std::string(name);
  }
  return "other_" + std::string(name);
}

class HeaderCleaner {
 public:
  HeaderCleaner(std::size_t file_size, std::string& out) : file_size_(file_size), out_(out) {}

  // One header line, as words.
  Status Add(const std::vector<std::string_view>& words) {
    if (words[0] == "format" && words.size() == 3) return AddFormat(words);
    if (words[0] == "element" && words.size() == 3) return AddElement(words);
    if (words[0] == "property" && words.size() == 3) return AddScalar(words[1], words[2]);
    if (words[0] == "property" && words.size() == 5 && words[1] == "list") return AddList(words);
    return Status::Corrupt("header: cannot read the line that starts with " + std::string(words[0]));
  }

  Status Finish() {
    if (!has_format_) return Status::Corrupt("header: no format");
    if (coordinates_ != 3) return Status::Corrupt("header: the vertices need float x, y and z");
    if (in_faces_ && !has_indices_) return Status::Corrupt("header: the faces have no vertex_indices");
    out_ += "end_header\n";
    return Status::Ok();
  }

  bool ascii() const { return ascii_; }
  bool has_lists() const { return has_lists_; }

 private:
  Status AddFormat(const std::vector<std::string_view>& words) {
    if (words[1] != "ascii" && words[1] != "binary_little_endian" && words[1] != "binary_big_endian") {
      return Status::Unsupported("header: format " + std::string(words[1]));
    }
    has_format_ = true;
    ascii_ = words[1] == "ascii";
    out_ += "format " + std::string(words[1]) + " 1.0\n";
    return Status::Ok();
  }

  Status AddElement(const std::vector<std::string_view>& words) {
    const std::string name(words[1]);
    after_faces_ |= in_faces_;
    in_vertices_ = name == "vertex";
    in_faces_ |= name == "face";
    if (after_faces_) {  // the reader stops after the faces
      return in_vertices_ ? Status::Unsupported("header: the faces precede the vertices") : Status::Ok();
    }
    // An element takes a byte at least, so this bounds the reader's loops.
    std::int64_t count = 0;
    if (!ParseInteger(words[2], count) || count < 0 || static_cast<std::uint64_t>(count) > file_size_) {
      return Status::Corrupt("header: " + std::string(words[2]) + " elements of type " + name + " in " +
                             std::to_string(file_size_) + " bytes");
    }
    out_ += "element " + name + " " + std::to_string(count) + "\n";
    return Status::Ok();
  }

  Status AddScalar(std::string_view type, std::string_view name) {
    if (after_faces_) return Status::Ok();
    if (!IsFloat(type) && !IsInteger(type)) return Status::Unsupported("header: type " + std::string(type));
    if (in_faces_ && !has_indices_) {
      return Status::Unsupported("header: property " + std::string(name) + " precedes the faces' vertex_indices");
    }
    // Only the vertices' properties have meanings here; the prefix keeps OpenMesh from reading any into the others.
    const std::string known = in_vertices_ ? VertexPropertyName(name, type) : "other_" + std::string(name);
    coordinates_ += known == "x" || known == "y" || known == "z" ? 1 : 0;
    out_ += "property " + std::string(type) + " " + known + "\n";
    return Status::Ok();
  }

  Status AddList(const std::vector<std::string_view>& words) {
    if (after_faces_) return Status::Ok();
    const std::string name(words[4]);
    if (!IsInteger(words[2]) || (!IsInteger(words[3]) && !IsFloat(words[3]))) {
      return Status::Unsupported("header: type of the list " + name);
    }
    const bool indices = in_faces_ && (name == "vertex_index" || name == "vertex_indices");
    if (!in_vertices_ && !in_faces_) return Status::Unsupported("header: the list " + name + " precedes the faces");
    if (in_faces_ && indices == has_indices_) {
      return Status::Unsupported("header: the faces need one list vertex_indices, before any other property");
    }
    if (indices && !IsInteger(words[3])) return Status::Corrupt("header: vertex_indices are no integers");
    // The reader knows four types of length; signs do not matter, lengths are not negative.
    const std::string_view type = words[2];
    const bool byte = type == "char" || type == "uchar" || type == "int8" || type == "uint8";
    const bool word = type == "short" || type == "ushort" || type == "int16" || type == "uint16";
    // It allocates a list before it reads one, so it must not be given lengths of 32 bits.
    if (!indices && !byte && !word) return Status::Unsupported("header: the list " + name + " has 32-bit lengths");
    has_lists_ |= !indices;
    has_indices_ |= indices;
    out_ += std::string("property list ") +
            (byte   ? "uchar"
             : word ? "uint16"
                    : "int") +
            " " + std::string(words[3]) + " " + name + "\n";
    return Status::Ok();
  }

  std::size_t file_size_;
  std::string& out_;
  bool has_format_ = false, ascii_ = false, has_lists_ = false, has_indices_ = false;
  bool in_vertices_ = false, in_faces_ = false, after_faces_ = false;
  int coordinates_ = 0;
};

// In text nothing bounds the length of a list; a number larger than the file could be one.
Status CheckAsciiLists(std::string_view body, std::size_t file_size) {
  for (auto word = TakeWord(body); !word.empty(); word = TakeWord(body)) {
    std::int64_t value = 0;
    const bool integer = std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (integer && (!ParseInteger(word, value) || static_cast<std::uint64_t>(value) > file_size)) {
      return Status::Unsupported("a file with lists and the number " + std::string(word.substr(0, 20)));
    }
  }
  return Status::Ok();
}

}  // namespace

Status CleanPly(std::string_view bytes, std::string& cleaned, bool& has_lists) {
  std::string_view rest = bytes;
  std::string_view magic_line = TakeLine(rest);
  const std::string_view magic = TakeWord(magic_line);
  if (magic != "ply" && magic != "PLY") return Status::Corrupt("not a PLY file");
  cleaned = "ply\n";
  HeaderCleaner header(bytes.size(), cleaned);
  while (true) {
    if (rest.empty()) return Status::Corrupt("header: ends before end_header");
    std::string_view line = TakeLine(rest);
    std::vector<std::string_view> words;
    for (auto word = TakeWord(line); !word.empty(); word = TakeWord(line)) words.push_back(word);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    SAC_RETURN_IF_ERROR(header.Add(words));
  }
  SAC_RETURN_IF_ERROR(header.Finish());
  has_lists = header.has_lists();
  if (has_lists && header.ascii()) SAC_RETURN_IF_ERROR(CheckAsciiLists(rest, bytes.size()));
  cleaned += rest;
  if (header.ascii()) cleaned += '\n';
  return Status::Ok();
}

}  // namespace sac

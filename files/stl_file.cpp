// SPDX-License-Identifier: Apache-2.0
#include "files/stl_file.h"

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <unordered_map>

#include "files/byte_order.h"
#include "files/text_scan.h"

namespace sac {
namespace {

constexpr std::size_t kHeaderBytes = 84;    // text, then the number of triangles
constexpr std::size_t kTriangleBytes = 50;  // normal, three corners, two bytes of attributes

class Welder {
 public:
  explicit Welder(Mesh& mesh) : mesh_(mesh) {}

  void Add(const std::array<Vec3f, 3>& corners) {
    mesh_.triangles.push_back({Index(corners[0]), Index(corners[1]), Index(corners[2])});
  }

 private:
  using Key = std::array<std::uint32_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t hash = 0;
      for (const std::uint32_t x : key) hash = (hash ^ x) * 0x9E3779B97F4A7C15U;
      return hash ^ hash >> 32;
    }
  };

  std::uint32_t Index(const Vec3f& position) {
    Key key{};
    for (int k = 0; k < 3; ++k) key[k] = std::bit_cast<std::uint32_t>(position[k] == 0 ? 0.0F : position[k]);
    const auto [found, added] = index_.try_emplace(key, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (added) mesh_.positions.push_back(position);
    return found->second;
  }

  Mesh& mesh_;
  std::unordered_map<Key, std::uint32_t, Hash> index_;
};

void ParseBinary(std::string_view bytes, Mesh& mesh) {
  Welder welder(mesh);
  for (std::size_t at = kHeaderBytes; at < bytes.size(); at += kTriangleBytes) {
    std::array<Vec3f, 3> corners{};
    const char* in = bytes.data() + at + 12;
    for (Vec3f& corner : corners) {
      for (float& x : corner) {
        x = LoadLittleFloat(in);
        in += 4;
      }
    }
    welder.Add(corners);
  }
}

Status ParseAscii(std::string_view text, Mesh& mesh) {
  Welder welder(mesh);
  std::array<Vec3f, 3> corners{};
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
      for (float& x : corners[corner_count]) {
        const std::string_view word = TakeWord(line);
        if (!ParseFloat(word, x)) return error("not a number: " + std::string(word));
      }
      ++corner_count;
    } else if (keyword == "endfacet" || keyword == "ENDFACET") {
      if (corner_count != 3) return error("a facet of " + std::to_string(corner_count) + " vertices");
      welder.Add(corners);
      corner_count = 0;
    } else if (keyword == "endsolid" || keyword == "ENDSOLID") {
      ended = true;
    } else if (keyword == "facet" || keyword == "FACET") {
      ended = false;
    }
  }
  return ended && corner_count == 0 ? Status::Ok() : Status::Corrupt("ends before endsolid");
}

}  // namespace

Status ParseStl(std::string_view bytes, Mesh& mesh) {
  mesh = {};
  // An ASCII file may start with any text and a binary one with "solid", so the size decides.
  const std::uint64_t count = bytes.size() < kHeaderBytes ? 0 : LoadLittle32(bytes.data() + kHeaderBytes - 4);
  const std::uint64_t whole = kHeaderBytes + count * kTriangleBytes;
  if (bytes.size() == whole) {
    ParseBinary(bytes, mesh);
    return Status::Ok();
  }
  std::string_view start = bytes.substr(0, kHeaderBytes);
  const std::string_view first = TakeWord(start);
  if (first == "solid" || first == "SOLID") return ParseAscii(bytes, mesh);
  return Status::Corrupt("neither ASCII STL nor binary STL of " + std::to_string(count) + " triangles, which takes " +
                         std::to_string(whole) + " bytes and not " + std::to_string(bytes.size()));
}

}  // namespace sac

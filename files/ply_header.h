// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sac/status.h"

namespace sac {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

// The bytes of a number in the binary formats.
std::size_t PlyBytes(PlyType type);

inline bool IsPlyInteger(PlyType type) { return type < PlyType::kFloat32; }

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;  // of the value, or of the values of a list
  std::optional<PlyType> count;      // of a list's length; none: a single value
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Format { kAscii, kLittleEndian, kBigEndian };

  Format format = Format::kAscii;
  std::vector<PlyElement> elements;
  std::size_t size = 0;  // in bytes, with the end of the line end_header
};

// Reads the header of a PLY file. Its lines end in LF, CR or CRLF, in binary files too. kCorrupt or kUnsupported,
// without the file's name; also for counts that the file is too short for, a row of an element being a byte or more.
Status ParsePlyHeader(std::string_view bytes, PlyHeader& header);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "files/ply_header.h"
#include "sac/status.h"

namespace sac {

// The numbers after the header of a PLY file, one after the other. Memory is that of the bytes, which must stay.
class PlyValues {
 public:
  // `bytes` are the whole file; of an ASCII file the normalized text.
  PlyValues(std::string_view bytes, const PlyHeader& header)
      : bytes_(bytes), at_(header.size), format_(header.format) {}

  // The next number, of any type as a double, which holds each of them. kCorrupt at the end of the file, or where a
  // word of an ASCII file is no number; that message begins with the line.
  Status Take(PlyType type, double& value);

  // The length of a list of `type`. kCorrupt also if it is negative or longer than what is left of the file.
  Status TakeCount(PlyType count_type, PlyType type, std::size_t& count);

  // "line 7, " of the number taken last in an ASCII file, else empty.
  std::string Where() const;

  // The word taken last, of an ASCII file.
  std::string_view word() const { return word_; }

 private:
  std::string_view bytes_, word_;
  std::size_t at_;
  PlyHeader::Format format_;
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "sac/status.h"

namespace sac {

// A file name with the frame number in it:
//   frame_%d.ply, frame_%04d.ply   as of C's printf: %d, or %0Nd with N in 1..20 for at least N digits; %% is a percent
//   sign frame_####.ply                 as many digits at least as there are signs frame_$F.ply, frame_$F4.ply    as of
//   Houdini: $F, or $FN with N in 1..9 frame_*.ply                    any digits; for reading only
// The first kind that is found counts, the other signs are letters. The number is in the file name, not in a directory.
class FramePattern {
 public:
  static bool IsPattern(const std::string& text);

  // kInvalidArgument unless `text` has exactly one such number.
  static Status Parse(const std::string& text, FramePattern& pattern);

  // The path of a frame. A pattern of * writes no zeros before the number.
  std::string Path(std::int64_t number) const;

  // Whether the digits are written as they like, so that the pattern is no name to write to.
  bool any_digits() const { return any_digits_; }
  const std::string& text() const { return text_; }

  // The files that exist, by number, which may be negative. With * a minus sign before every number is none. kIoError,
  // naming the pattern, if there are none or the directory cannot be read; kInvalidArgument if two have one number, or
  // one is beyond 63 bits.
  Status List(std::map<std::int64_t, std::string>& files) const;

 private:
  // Whether a name in the directory is one of the pattern's; `number` becomes its number, nothing where it is too
  // large.
  bool Matches(const std::string& name, std::optional<std::int64_t>& number) const;

  std::string text_, directory_, prefix_, suffix_;
  std::size_t width_ = 0;
  bool any_digits_ = false;
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sac/status.h"

namespace sac {

// A file name with the frame number in it, as `frame_%04d.ply`: %d, or %0Nd with N in 1..20 for at least N digits; %%
// is a percent sign. The number is in the file name, not in a directory.
class FramePattern {
 public:
  static bool IsPattern(const std::string& text) { return text.find('%') != std::string::npos; }

  // kInvalidArgument unless `text` has exactly one such number.
  static Status Parse(const std::string& text, FramePattern& pattern);

  // The path of a frame.
  std::string Path(std::uint64_t number) const;

  // The files that exist, from the lowest number in the directory to the last before a gap. kIoError, naming the
  // pattern, if there are none.
  Status List(std::vector<std::string>& paths) const;

 private:
  std::string text_, directory_, prefix_, suffix_;
  std::size_t width_ = 0;
};

}  // namespace sac

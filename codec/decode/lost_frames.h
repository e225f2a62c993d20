// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sac/decoder.h"

namespace sac {

// The frames that are lost by damage.
class LostFrames {
 public:
  // Adds the frames from `first` to before `end`. Some of them may have been added before.
  void Add(std::uint64_t first, std::uint64_t end) {
    // Algorithms of std::ranges are missing in libc++ 14.
    auto at = std::lower_bound(ranges_.begin(), ranges_.end(), first,
                               [](const FrameRange& range, std::uint64_t frame) { return End(range) < frame; });
    while (at != ranges_.end() && at->first <= end) {  // merges the ranges that overlap or touch the new one
      first = std::min<std::uint64_t>(first, at->first);
      end = std::max(end, End(*at));
      at = ranges_.erase(at);
    }
    if (first < end) ranges_.insert(at, {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end - first)});
  }
  bool any() const { return !ranges_.empty(); }
  bool Has(std::uint64_t frame) const {
    const auto at = std::upper_bound(ranges_.begin(), ranges_.end(), frame,
                                     [](std::uint64_t f, const FrameRange& range) { return f < End(range); });
    return at != ranges_.end() && at->first <= frame;
  }
  // The lost frames as ascending ranges that do not touch each other.
  const std::vector<FrameRange>& ranges() const { return ranges_; }

 private:
  static std::uint64_t End(const FrameRange& range) { return std::uint64_t{range.first} + range.count; }
  std::vector<FrameRange> ranges_;
};

}  // namespace sac

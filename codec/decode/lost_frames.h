#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sac/decoder.h"

namespace sac {

// The frames that damage has cost.
class LostFrames {
 public:
  // Those from `first` to before `end`; some may be there already.
  void Add(std::uint64_t first, std::uint64_t end) {
    auto at = std::ranges::lower_bound(ranges_, first, {}, End);
    while (at != ranges_.end() && at->first <= end) {  // joins with what it touches
      first = std::min<std::uint64_t>(first, at->first);
      end = std::max(end, End(*at));
      at = ranges_.erase(at);
    }
    if (first < end) ranges_.insert(at, {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end - first)});
  }
  bool any() const { return !ranges_.empty(); }
  bool Has(std::uint64_t frame) const {
    const auto at = std::ranges::upper_bound(ranges_, frame, {}, End);
    return at != ranges_.end() && at->first <= frame;
  }
  // Ascending; none touches another.
  const std::vector<FrameRange>& ranges() const { return ranges_; }

 private:
  static std::uint64_t End(const FrameRange& range) { return std::uint64_t{range.first} + range.count; }
  std::vector<FrameRange> ranges_;
};

}  // namespace sac

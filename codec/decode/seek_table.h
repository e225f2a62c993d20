#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <vector>

#include "format/stream_index.h"

namespace sac {

// Where groups begin, as far as known.
class SeekTable {
 public:
  // The end of the I-frame: no group begins before. `is_first`: the first one begins there.
  void Start(std::uint64_t byte, bool is_first) {
    start_ = {byte, std::nullopt};
    if (is_first) start_.first_frame = 0;
  }

  void Add(std::uint64_t byte, std::uint32_t first_frame) {
    if (has_index_) return;
    const auto at = std::ranges::lower_bound(places_, byte, {}, &Place::byte);
    if (at == places_.end() || at->byte != byte) places_.insert(at, {byte, first_frame});
  }

  // All of them; returns the byte after the last group.
  std::uint64_t Take(const StreamIndex& index) {
    has_index_ = true;
    places_.clear();
    std::uint64_t byte = index.first_group;
    std::uint32_t frame = 0;
    for (const StreamIndex::Group& group : index.groups) {
      places_.push_back({byte, frame});
      byte += group.bytes;
      frame += group.frames;
    }
    return byte;
  }

  struct Place {
    std::uint64_t byte;
    std::optional<std::uint32_t> first_frame;  // of the group; none when it is not known
    bool operator==(const Place&) const = default;
  };

  // Where to read on for `frame`: the last known group that begins with it or before.
  Place Find(std::uint32_t frame) const {
    const auto at = std::ranges::upper_bound(places_, frame, {}, &Place::first_frame);
    return at == places_.begin() ? start_ : *std::prev(at);
  }

  // Whether `index` says the same of a stream whose end packet begins at `end`.
  bool Matches(const StreamIndex& index, std::uint64_t end) const {
    SeekTable other;
    return other.Take(index) == end && places_ == other.places_;
  }

 private:
  bool has_index_ = false;
  Place start_ = {0, std::nullopt};
  std::vector<Place> places_;  // ascending
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <vector>

#include "format/stream_index.h"

namespace sac {

// The places in a stream where groups begin, as far as they are known.
class SeekTable {
 public:
  // Sets the byte at which the I-frame ends; no group begins before it. With `is_first` the group of frame 0 begins
  // there.
  void Start(std::uint64_t byte, bool is_first) {
    start_ = {byte, std::nullopt};
    if (is_first) start_.first_frame = 0;
  }

  // Adds a group that begins at `byte` with the frame `first_frame`.
  void Add(std::uint64_t byte, std::uint32_t first_frame) {
    if (has_index_) return;
    const auto at = std::lower_bound(places_.begin(), places_.end(), byte,
                                     [](const Place& place, std::uint64_t b) { return place.byte < b; });
    if (at == places_.end() || at->byte != byte) places_.insert(at, {byte, first_frame});
  }

  // Replaces all places by those of an index. Returns the byte after the last group.
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

  // Returns where to read on for `frame`: the last known group that begins with it or before.
  Place Find(std::uint32_t frame) const {
    const auto at = std::upper_bound(places_.begin(), places_.end(), frame,
                                     [](std::uint32_t f, const Place& place) { return f < place.first_frame; });
    return at == places_.begin() ? start_ : *std::prev(at);
  }

  // Whether `index` lists the same places and its last group ends at byte `end`, where the end packet begins.
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

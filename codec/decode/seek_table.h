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

// The places in a stream where groups and segments begin, as far as they are known.
class SeekTable {
 public:
  // Adds a start that begins at byte `begin` and whose I-frame ends at `end`. With `opens_stream` the group of frame 0
  // comes next.
  void AddStart(std::uint64_t begin, std::uint64_t end, bool opens_stream) {
    last_start_ = begin;
    if (!entry_) entry_ = {begin, end, opens_stream ? std::optional<std::uint32_t>(0) : std::nullopt};
  }

  // Adds a group that begins at `byte` with the frame `first_frame`. A group of a segment that is not known yet follows
  // the last start.
  void Add(std::uint64_t byte, std::uint32_t first_frame, std::uint32_t segment) {
    if (has_index_) return;
    if (StartOf(segment) == nullptr) segments_.push_back({segment, last_start_});
    const auto at = std::lower_bound(groups_.begin(), groups_.end(), byte,
                                     [](const Group& group, std::uint64_t b) { return group.byte < b; });
    if (at == groups_.end() || at->byte != byte) groups_.insert(at, {byte, first_frame, segment});
  }

  // Replaces all places by those of an index. Returns the byte after the last group.
  std::uint64_t Take(const StreamIndex& index) {
    has_index_ = true;
    groups_.clear();
    segments_.clear();
    std::uint64_t byte = index.first_group, next_segment = 0;
    std::uint32_t frame = 0, segment = 0;
    if (!index.segments.empty()) next_segment = index.segments[0].groups;
    for (std::size_t i = 0; i < index.groups.size(); ++i) {
      if (segment < index.segments.size() && i == next_segment) {
        segments_.push_back({segment + 1, byte - std::min<std::uint64_t>(byte, index.segments[segment].start)});
        if (++segment < index.segments.size()) next_segment += index.segments[segment].groups;
      }
      groups_.push_back({byte, frame, segment});
      byte += index.groups[i].bytes;
      frame += index.groups[i].frames;
    }
    return byte;
  }

  struct Place {
    std::uint64_t byte;
    std::optional<std::uint32_t> first_frame;  // of the group that comes next there; none when it is not known
  };

  // Returns where to read on for `frame` with the start of segment `held`: the last known group that begins with it or
  // before, or the start that this group needs. A start has been added.
  Place Find(std::uint32_t frame, std::optional<std::uint32_t> held) const {
    const auto at = std::upper_bound(groups_.begin(), groups_.end(), frame,
                                     [](std::uint32_t f, const Group& group) { return f < group.first_frame; });
    if (at == groups_.begin()) {
      // Only the start that was read first is known to come before.
      const bool is_held = !held || groups_.empty() || groups_.front().segment == *held;
      return {is_held ? entry_->end : entry_->begin, entry_->first_frame};
    }
    const Group& group = *std::prev(at);
    if (!held || group.segment == *held) return {group.byte, group.first_frame};
    const Segment* const segment = StartOf(group.segment);
    return {segment ? segment->start : kFirstStart, std::nullopt};
  }

  // Whether `index` lists the same places and its last group ends at byte `end`, where the end packet begins.
  bool Matches(const StreamIndex& index, std::uint64_t end) const {
    SeekTable other;
    const bool same_end = other.Take(index) == end;
    const auto is_listed = [&](const Segment& segment) {
      const Segment* const listed = other.StartOf(segment.number);
      return segment.number == 0 || (listed && listed->start == segment.start);
    };
    return same_end && groups_ == other.groups_ && std::all_of(segments_.begin(), segments_.end(), is_listed);
  }

 private:
  static constexpr std::uint64_t kFirstStart = 4;  // behind the magic

  struct Group {
    std::uint64_t byte;
    std::uint32_t first_frame;
    std::uint32_t segment;
    bool operator==(const Group&) const = default;
  };
  struct Segment {
    std::uint32_t number;
    std::uint64_t start;  // byte of its first start that is known
  };
  struct Entry {
    std::uint64_t begin, end;
    std::optional<std::uint32_t> first_frame;
  };

  const Segment* StartOf(std::uint32_t number) const {
    for (const Segment& segment : segments_) {
      if (segment.number == number) return &segment;
    }
    return nullptr;
  }

  bool has_index_ = false;
  std::optional<Entry> entry_;  // the start that was read first
  std::uint64_t last_start_ = 0;
  std::vector<Group> groups_;      // ascending
  std::vector<Segment> segments_;  // of groups_, but the first where an index lists them
};

}  // namespace sac

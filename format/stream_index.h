// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sac/limits.h"
#include "sac/status.h"

namespace sac {

// Where the groups of a stream begin (spec.md 3.2).
struct StreamIndex {
  struct Group {
    std::uint32_t bytes = 0;   // from the group's packet to the next group's or to the end packet
    std::uint32_t frames = 0;  // in the group
    bool operator==(const Group&) const = default;
  };

  // A segment after the first.
  struct Segment {
    std::uint32_t groups = 0;  // from the first group of the segment before to its own
    std::uint32_t start = 0;   // bytes from its sequence header to its first group's packet
    bool operator==(const Segment&) const = default;
  };

  std::uint32_t first_group = 0;  // bytes before the first group's packet
  std::vector<Segment> segments;
  std::vector<Group> groups;

  bool operator==(const StreamIndex&) const = default;
};

// The syntax elements of an end packet (spec.md 3.2).
struct EndSyntax {
  std::uint32_t frames = 0;  // of the stream
  std::optional<StreamIndex> index;
};

// Returns the payload of an end packet.
std::vector<std::uint8_t> WriteEnd(const EndSyntax& end);

// Parses what WriteEnd() writes. Returns kCorrupt when the payload is malformed, and kLimit when the index takes more
// memory than the limit.
Status ParseEnd(std::span<const std::uint8_t> payload, const Limits& limits, EndSyntax& end);

// The number of bytes at the end of a stream with an index that state the size of its end packet.
inline constexpr std::size_t kStreamTail = 8;

// Reads the index of a stream whose last bytes are `tail`. Returns kNeedMoreData when the end packet is larger than
// `tail`; `needed` is then the number of last bytes that hold it. Returns kInvalidArgument when the stream has no index
// or is not whole or when its end packet is larger than the limit, and kLimit when the index takes more memory than the
// limit.
Status ReadIndex(std::span<const std::uint8_t> tail, const Limits& limits, StreamIndex& index, std::size_t& needed);

}  // namespace sac

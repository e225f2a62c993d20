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
    std::uint32_t bytes = 0;   // from its packet to the next group's, or to the end packet
    std::uint32_t frames = 0;  // of it
    bool operator==(const Group&) const = default;
  };

  std::uint32_t first_group = 0;  // bytes before the first group's packet
  std::vector<Group> groups;

  bool operator==(const StreamIndex&) const = default;
};

// What an end packet says.
struct EndSyntax {
  std::uint32_t frames = 0;  // of the stream
  std::optional<StreamIndex> index;
};

// The payload of an end packet.
std::vector<std::uint8_t> WriteEnd(const EndSyntax& end);

// The inverse. kCorrupt when malformed; kLimit when the index takes more memory than the limit.
Status ParseEnd(std::span<const std::uint8_t> payload, const Limits& limits, EndSyntax& end);

// A stream with an index tells in its last bytes how large its end packet is.
inline constexpr std::size_t kStreamTail = 8;

// The index of a stream whose last bytes are `tail`. kNeedMoreData when the end packet is larger than `tail`: `needed`
// says how many of the last bytes hold it. kInvalidArgument when the stream has no index, or is not whole, or the end
// packet is larger than the limit; kLimit likewise of the index.
Status ReadIndex(std::span<const std::uint8_t> tail, const Limits& limits, StreamIndex& index, std::size_t& needed);

}  // namespace sac

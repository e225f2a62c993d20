#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sac/status.h"

namespace sac {

// What a group packet says before its frames' range code (spec.md 6).
struct GroupSyntax {
  std::uint32_t frames = 0;       // 0: an open group, whose frames come in records
  std::uint32_t first_frame = 0;  // the number of its first frame in the clip
  std::uint32_t pyramid = 1;      // frames of a hierarchy of B-frames; 1: P-frames only. Not of an open group

  bool open() const { return frames == 0; }
};

// The payload of a group packet.
std::vector<std::uint8_t> WriteGroup(const GroupSyntax& group, std::span<const std::uint8_t> code);

// The inverse; `code` is a part of `payload`. kCorrupt when malformed or when frames would have numbers of 2^32 or
// more.
Status ParseGroup(std::span<const std::uint8_t> payload, GroupSyntax& group, std::span<const std::uint8_t>& code);

// Whether a group packet opens a group: records follow it, not packets.
bool OpensGroup(std::span<const std::uint8_t> payload);

}  // namespace sac

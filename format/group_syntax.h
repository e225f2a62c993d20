// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sac/status.h"

namespace sac {

// The syntax elements of a group packet before the range code of its frames (spec.md 6).
struct GroupSyntax {
  std::uint32_t frames = 0;       // 0: an open group, whose frames come in records
  std::uint32_t first_frame = 0;  // the number of its first frame in the clip
  std::uint32_t pyramid = 1;      // frames of a hierarchy of B-frames; 1: P-frames only. Unused in an open group

  bool open() const { return frames == 0; }
};

// Returns the payload of a group packet whose frames have the range code `code`.
std::vector<std::uint8_t> WriteGroup(const GroupSyntax& group, std::span<const std::uint8_t> code);

// Parses what WriteGroup() writes; `code` becomes a part of `payload`. Returns kCorrupt when the payload is malformed
// or when a frame's number would be 2^32 or more.
Status ParseGroup(std::span<const std::uint8_t> payload, GroupSyntax& group, std::span<const std::uint8_t>& code);

// Whether a group packet with this payload opens a group, so that records follow it instead of packets (spec.md 3.1).
bool OpensGroup(std::span<const std::uint8_t> payload);

}  // namespace sac

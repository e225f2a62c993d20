// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/references.h"
#include "sac/status.h"

namespace sac {

// The syntax elements of a group packet before the range code of its frames (spec.md 6).
struct GroupSyntax {
  std::uint32_t frames = 0;       // 0: an open group, whose frames come in records
  std::uint32_t first_frame = 0;  // the number of its first frame in the clip
  std::uint32_t pyramid = 1;      // frames of a hierarchy of B-frames; 1: P-frames only, as in an open group
  std::uint32_t segment = 0;      // the number of the segment whose mesh the frames move
  // In a layered group the levels of the pyramid whose frames are in its own packet; 0: the group has no layers.
  std::uint32_t base_levels = 0;

  bool open() const { return frames == 0; }
  bool layered() const { return base_levels > 0; }
};

// Returns the payload of a group packet whose frames have the range code `code`.
std::vector<std::uint8_t> WriteGroup(const GroupSyntax& group, std::span<const std::uint8_t> code);

// Parses what WriteGroup() writes; `code` becomes a part of `payload`. Returns kCorrupt when the payload is malformed
// or a frame's number would be 2^32 or more.
Status ParseGroup(std::span<const std::uint8_t> payload, GroupSyntax& group, std::span<const std::uint8_t>& code);

// The syntax elements of a layer packet before its range code (spec.md 6.4).
struct LayerSyntax {
  std::uint32_t first_frame = 0;  // that of its group
  std::uint32_t layer = 1;        // its number in the group, from 1
};

std::vector<std::uint8_t> WriteLayer(const LayerSyntax& layer, std::span<const std::uint8_t> code);

// Parses what WriteLayer() writes; `code` becomes a part of `payload`. Returns kCorrupt when the payload is malformed.
Status ParseLayer(std::span<const std::uint8_t> payload, LayerSyntax& layer, std::span<const std::uint8_t>& code);

// Whether a group packet with this payload opens a group, so that records follow it instead of packets (spec.md 3.1).
bool OpensGroup(std::span<const std::uint8_t> payload);

// The place of one frame of a group: where it is shown, and what it is predicted from unless it says otherwise.
struct FrameSlot {
  std::uint32_t display;  // index in the group by time
  std::uint32_t level;    // of the pyramid: 0 for key and P-frames, one more with each halving
  References references;  // earlier slots
};

// The frames of a group in coding order (spec.md 6.1): the key frame, then pyramids of `pyramid` frames, of which the
// last is predicted from the last of the pyramid before and those between by halving, from both sides. A pyramid of 1
// is a chain of P-frames.
std::vector<FrameSlot> GroupStructure(std::uint32_t frames, std::uint32_t pyramid);

// The same frames in the coding order of a layered group (spec.md 6.1): first those of levels below `base_levels`, then
// those of each level. References are to slots of this order. `slots` are GroupStructure()'s.
std::vector<FrameSlot> LayeredOrder(const std::vector<FrameSlot>& slots, std::uint32_t base_levels);

// The same slot of a chain of P-frames, whose length need not be known: of an open group.
FrameSlot ChainSlot(std::uint32_t index);

}  // namespace sac

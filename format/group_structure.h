// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "format/references.h"

namespace sac {

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

// The same slot of a chain of P-frames, whose length need not be known: of an open group.
FrameSlot ChainSlot(std::uint32_t index);

}  // namespace sac

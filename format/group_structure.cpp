// SPDX-License-Identifier: Apache-2.0
#include "format/group_structure.h"

#include <algorithm>

namespace sac {
namespace {

void Halve(std::vector<FrameSlot>& slots, std::uint32_t before, std::uint32_t after, std::uint32_t level) {
  const std::uint32_t from = slots[before].display, to = slots[after].display;
  if (to - from < 2) return;
  const auto middle = static_cast<std::uint32_t>(slots.size());
  slots.push_back({from + (to - from) / 2, level, {before, after}});
  Halve(slots, before, middle, level + 1);
  Halve(slots, middle, after, level + 1);
}

}  // namespace

std::vector<FrameSlot> GroupStructure(std::uint32_t frames, std::uint32_t pyramid) {
  std::vector<FrameSlot> slots = {{0, 0, {}}};
  std::uint32_t last = 0;
  while (slots[last].display + 1 < frames) {
    const auto next = static_cast<std::uint32_t>(slots.size());
    slots.push_back({std::min(slots[last].display + pyramid, frames - 1), 0, {last}});
    Halve(slots, last, next, 1);
    last = next;
  }
  return slots;
}

FrameSlot ChainSlot(std::uint32_t index) { return index == 0 ? FrameSlot{0, 0, {}} : FrameSlot{index, 0, {index - 1}}; }

}  // namespace sac

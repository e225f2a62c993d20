// SPDX-License-Identifier: Apache-2.0
#include "format/group.h"

#include <algorithm>
#include <utility>

#include "format/bytes.h"

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

std::vector<std::uint8_t> WriteGroup(const GroupSyntax& group, std::span<const std::uint8_t> code) {
  ByteWriter out;
  out.Varint(group.frames);
  out.Varint(group.first_frame);
  out.Varint(group.pyramid * 4 + (group.segment > 0 ? 2u : 0u) + (group.layered() ? 1u : 0u));
  if (group.segment > 0) out.Varint(group.segment);
  if (group.layered()) out.Varint(group.base_levels);
  out.Bytes(code);
  return std::move(out.bytes());
}

Status ParseGroup(std::span<const std::uint8_t> payload, GroupSyntax& group, std::span<const std::uint8_t>& code) {
  ByteReader reader(payload);
  group.frames = reader.Varint();
  group.first_frame = reader.Varint();
  const std::uint32_t structure = reader.Varint();
  const bool has_segment = (structure & 2) != 0, has_layers = (structure & 1) != 0;
  group.pyramid = structure / 4;
  group.segment = has_segment ? reader.Varint() : 0;
  group.base_levels = has_layers ? reader.Varint() : 0;
  if (!reader.ok() || group.pyramid == 0) return Status::Corrupt("group: malformed");
  if (has_segment != (group.segment > 0) || has_layers != group.layered()) {
    return Status::Corrupt("group: a zero that is not needed");
  }
  if (group.open() && (group.pyramid != 1 || group.layered())) return Status::Corrupt("group: an open group of levels");
  if (group.open() && reader.remaining() > 0) return Status::Corrupt("group: an open group with bytes of its own");
  if (group.frames > 0xffffffffu - group.first_frame) return Status::Corrupt("group: too many frames");
  code = payload.subspan(reader.position());
  return Status::Ok();
}

std::vector<std::uint8_t> WriteLayer(const LayerSyntax& layer, std::span<const std::uint8_t> code) {
  ByteWriter out;
  out.Varint(layer.first_frame);
  out.Varint(layer.layer);
  out.Bytes(code);
  return std::move(out.bytes());
}

Status ParseLayer(std::span<const std::uint8_t> payload, LayerSyntax& layer, std::span<const std::uint8_t>& code) {
  ByteReader reader(payload);
  layer.first_frame = reader.Varint();
  layer.layer = reader.Varint();
  if (!reader.ok() || layer.layer == 0) return Status::Corrupt("layer: malformed");
  code = payload.subspan(reader.position());
  return Status::Ok();
}

bool OpensGroup(std::span<const std::uint8_t> payload) { return !payload.empty() && payload[0] == 0; }

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

std::vector<FrameSlot> LayeredOrder(const std::vector<FrameSlot>& slots, std::uint32_t base_levels) {
  std::vector<std::uint32_t> order(slots.size()), place(slots.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto layer = [&](std::uint32_t i) { return std::max(slots[i].level + 1, base_levels); };
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return layer(a) < layer(b); });
  std::vector<FrameSlot> ordered;
  for (const std::uint32_t i : order) {
    place[i] = static_cast<std::uint32_t>(ordered.size());
    ordered.push_back(slots[i]);
    for (std::uint32_t& reference : ordered.back().references) reference = place[reference];
  }
  return ordered;
}

FrameSlot ChainSlot(std::uint32_t index) { return index == 0 ? FrameSlot{0, 0, {}} : FrameSlot{index, 0, {index - 1}}; }

}  // namespace sac

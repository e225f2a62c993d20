// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/group_parser.h"

#include <string>
#include <utility>

#include "format/group.h"

namespace sac {
namespace {

Status AtFrame(std::uint32_t frame, const Status& s) {
  return {s.code(), "frame " + std::to_string(frame) + ": " + s.message()};
}

// The frames of `group` by time. `coded` holds those of the first slots; what it does not reach is not whole.
CodedFrames InDisplayOrder(const GroupSyntax& group, const std::vector<FrameSlot>& slots,
                           std::vector<FrameCoefficients> coded, const std::vector<bool>& intra) {
  CodedFrames out;
  out.first = group.first_frame;
  out.frames.assign(group.frames, {});
  for (CodedFrames::Frame& frame : out.frames) frame.whole = false;
  for (std::size_t i = 0; i < coded.size(); ++i) out.frames[slots[i].display] = {std::move(coded[i]), intra[i], true};
  return out;
}

}  // namespace

Status GroupParser::CheckSize(std::uint32_t frames) const {
  if (frames > frames_per_group_) {
    return Status::Limit(std::to_string(frames) + " frames in a group, the limit is " +
                         std::to_string(frames_per_group_));
  }
  if (frames * FrameValues(layouts_) > group_values_) {
    return Status::Limit("a group holds more coefficients than the limit");
  }
  return Status::Ok();
}

Status GroupParser::CheckGroup(const GroupSyntax& group) const {
  SAC_RETURN_IF_ERROR(CheckSize(group.frames));
  if (header_.references_previous() && (group.pyramid != 1 || group.layered()))
    return Status::Corrupt("group: B-frames or layers against the previous frame");
  return Status::Ok();
}

Status GroupParser::ParseFrame(const FrameSlot& slot, bool layered, RangeDecoder& range,
                               FrameCoder<RangeDecoder>& coder, bool& intra) const {
  FrameSyntax frame;
  const bool good = layered ? coder.CodeBase(range, slot, frame) : coder.Code(range, slot, frame);
  if (!good) return Status::Corrupt("malformed coefficients");
  if (header_.references_previous() && !frame.intra() && frame.slot.references != slot.references) {
    return Status::Corrupt("not predicted from the frame before");
  }
  intra = frame.intra();
  return Status::Ok();
}

Status GroupParser::Parse(const GroupSyntax& group, std::span<const std::uint8_t> code, bool cut,
                          CodedFrames& out) const {
  SAC_RETURN_IF_ERROR(CheckGroup(group));
  RangeDecoder range(code);
  FrameCoder<RangeDecoder> coder(header_, layouts_);
  const std::vector<FrameSlot> structure = GroupStructure(group.frames, group.pyramid);
  std::vector<bool> intra(structure.size());
  std::size_t parsed = 0;
  for (; parsed < structure.size(); ++parsed) {
    bool is_intra = false;
    const Status s = ParseFrame(structure[parsed], false, range, coder, is_intra);
    if (cut && (!s.ok() || !range.IsCertain())) break;
    if (!s.ok()) return AtFrame(group.first_frame + structure[parsed].display, s);
    intra[parsed] = is_intra;
  }
  if (cut && parsed == 0) return Status::Corrupt("group: no frame is whole");
  if (!cut && !range.AtEnd()) return Status::Corrupt("group: bytes after the last frame");
  std::vector<FrameCoefficients> coded = coder.TakeFrames();
  coded.resize(parsed);  // without one that only seems to be whole
  out = InDisplayOrder(group, structure, std::move(coded), intra);
  return Status::Ok();
}

Status GroupParser::CountLayers(const GroupSyntax& group, std::size_t& layers) const {
  SAC_RETURN_IF_ERROR(CheckGroup(group));
  const std::vector<FrameSlot> slots = LayeredOrder(GroupStructure(group.frames, group.pyramid), group.base_levels);
  layers = LayersOf(slots, group.base_levels, layouts_).size();
  return Status::Ok();
}

Status GroupParser::ParseLayers(const GroupSyntax& group, std::span<const std::vector<std::uint8_t>> codes,
                                CodedFrames& out) const {
  SAC_RETURN_IF_ERROR(CheckGroup(group));
  FrameCoder<RangeDecoder> coder(header_, layouts_);
  const std::vector<FrameSlot> slots = LayeredOrder(GroupStructure(group.frames, group.pyramid), group.base_levels);
  const std::vector<GroupLayer> layers = LayersOf(slots, group.base_levels, layouts_);
  std::vector<bool> intra(slots.size());
  std::size_t coded_frames = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    Status status = ParseLayer(layers[i], slots, codes[i], coder, intra);
    if (!status.ok())
      return {status.code(), "group of frame " + std::to_string(group.first_frame) + ", layer " + std::to_string(i) +
                                 ": " + status.message()};
    if (layers[i].has_frames()) coded_frames = layers[i].end;
  }
  for (; coded_frames < slots.size(); ++coded_frames) {
    if (!coder.Skip(slots[coded_frames])) return Status::Corrupt("group: coefficients out of range");
  }
  out = InDisplayOrder(group, slots, coder.TakeFrames(), intra);
  return Status::Ok();
}

Status GroupParser::ParseLayer(const GroupLayer& layer, const std::vector<FrameSlot>& slots,
                               std::span<const std::uint8_t> code, FrameCoder<RangeDecoder>& coder,
                               std::vector<bool>& intra) const {
  RangeDecoder range(code);
  FrameSyntax frame;
  for (std::size_t i = layer.first; i < layer.end; ++i) {
    bool is_intra = false;
    if (layer.has_frames()) {
      SAC_RETURN_IF_ERROR(ParseFrame(slots[i], true, range, coder, is_intra));
      intra[i] = is_intra;
    } else if (!coder.CodeLater(range, i, layer.plane, frame)) {
      return Status::Corrupt("malformed coefficients");
    }
  }
  return range.AtEnd() ? Status::Ok() : Status::Corrupt("bytes after the last frame");
}

void GroupParser::Open(std::uint32_t first_frame) {
  open_.emplace(header_, layouts_);
  open_first_ = first_frame;
}

Status GroupParser::ParseNext(std::span<const std::uint8_t> code, CodedFrames& out) {
  const auto index = static_cast<std::uint32_t>(open_->predictor().frames().size());
  SAC_RETURN_IF_ERROR(CheckSize(index + 1));
  if (index == 0xffffffffu - open_first_) return Status::Corrupt("group: too many frames");
  const std::uint32_t number = open_first_ + index;
  RangeDecoder range(code);
  bool intra = false;
  if (const Status s = ParseFrame(ChainSlot(index), false, range, *open_, intra); !s.ok()) return AtFrame(number, s);
  if (!range.AtEnd()) return AtFrame(number, Status::Corrupt("bytes after its end"));
  out.first = number;
  out.frames.assign(1, {open_->predictor().frames().back(), intra, true});
  return Status::Ok();
}

}  // namespace sac

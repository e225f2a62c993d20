// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/group_parser.h"

#include <string>
#include <utility>

#include "format/group_structure.h"

namespace sac {
namespace {

Status AtFrame(std::uint32_t frame, const Status& s) {
  return {s.code(), "frame " + std::to_string(frame) + ": " + s.message()};
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

Status GroupParser::ParseFrame(const FrameSlot& slot, RangeDecoder& range, FrameCoder<RangeDecoder>& coder,
                               bool& intra) const {
  FrameSyntax frame;
  if (!coder.Code(range, slot, frame)) return Status::Corrupt("malformed coefficients");
  if (header_.references_previous() && !frame.intra() && frame.slot.references != slot.references) {
    return Status::Corrupt("not predicted from the frame before");
  }
  intra = frame.intra();
  return Status::Ok();
}

Status GroupParser::Parse(const GroupSyntax& group, std::span<const std::uint8_t> code, bool cut,
                          CodedFrames& out) const {
  SAC_RETURN_IF_ERROR(CheckSize(group.frames));
  if (header_.references_previous() && group.pyramid != 1)
    return Status::Corrupt("group: B-frames against the previous frame");
  RangeDecoder range(code);
  FrameCoder<RangeDecoder> coder(header_, layouts_);
  const std::vector<FrameSlot> structure = GroupStructure(group.frames, group.pyramid);
  std::vector<bool> intra(structure.size());
  std::size_t parsed = 0;
  for (; parsed < structure.size(); ++parsed) {
    bool is_intra = false;
    const Status s = ParseFrame(structure[parsed], range, coder, is_intra);
    if (cut && (!s.ok() || !range.IsCertain())) break;
    if (!s.ok()) return AtFrame(group.first_frame + structure[parsed].display, s);
    intra[parsed] = is_intra;
  }
  if (cut && parsed == 0) return Status::Corrupt("group: no frame is whole");
  if (!cut && !range.AtEnd()) return Status::Corrupt("group: bytes after the last frame");
  std::vector<FrameCoefficients> coded = coder.TakeFrames();
  out.first = group.first_frame;
  out.frames.assign(group.frames, {});
  for (CodedFrames::Frame& frame : out.frames) frame.whole = false;
  for (std::size_t i = 0; i < parsed; ++i) {
    out.frames[structure[i].display] = {std::move(coded[i]), intra[i], true};
  }
  return Status::Ok();
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
  if (const Status s = ParseFrame(ChainSlot(index), range, *open_, intra); !s.ok()) return AtFrame(number, s);
  if (!range.AtEnd()) return AtFrame(number, Status::Corrupt("bytes after its end"));
  out.first = number;
  out.frames.assign(1, {open_->predictor().frames().back(), intra, true});
  return Status::Ok();
}

}  // namespace sac

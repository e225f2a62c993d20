// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/shape.h"
#include "format/frame_coder.h"
#include "format/group_syntax.h"
#include "format/sequence_header.h"
#include "sac/limits.h"
#include "sac/status.h"

namespace sac {

// Frames that follow each other in time, as coefficients.
struct CodedFrames {
  struct Frame {
    FrameCoefficients coefficients;
    bool intra = false;  // predicted from no other frame
    bool whole = true;   // false when some of the frame's bytes are missing
  };

  std::uint32_t first = 0;  // the number of frames[0] in the clip
  std::vector<Frame> frames;

  std::uint64_t end() const { return std::uint64_t{first} + frames.size(); }
};

// Reads the frames of groups, that is, turns bytes into coefficients (spec.md 6.2, 6.3).
class GroupParser {
 public:
  // `header` and `shape` must outlive the object.
  GroupParser(const SequenceHeader& header, const Shape& shape, const Limits& limits)
      : header_(header),
        layouts_(shape.layouts),
        frames_per_group_(limits.expert.frames_per_group),
        group_values_(MaxGroupValues(limits, shape)) {}

  // Parses the frames of a group. With `cut`, `code` may end early: frames whose bytes are missing are then marked as
  // not whole. Returns kCorrupt, with the frame's number, when the code is wrong or no frame is whole; kLimit when the
  // group is larger than the limits.
  Status Parse(const GroupSyntax& group, std::span<const std::uint8_t> code, bool cut, CodedFrames& out) const;

  // Begins an open group, whose frames come one by one to ParseNext().
  void Open(std::uint32_t first_frame);
  Status ParseNext(std::span<const std::uint8_t> code, CodedFrames& out);
  void Close() { open_.reset(); }
  bool is_open() const { return open_.has_value(); }

 private:
  Status CheckSize(std::uint32_t frames) const;
  Status ParseFrame(const FrameSlot& slot, RangeDecoder& range, FrameCoder<RangeDecoder>& coder, bool& intra) const;

  const SequenceHeader& header_;
  const PlaneLayouts& layouts_;
  const std::uint32_t frames_per_group_;
  const std::uint64_t group_values_;
  std::optional<FrameCoder<RangeDecoder>> open_;
  std::uint32_t open_first_ = 0;
};

}  // namespace sac

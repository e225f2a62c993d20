// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/shape.h"
#include "format/frame_coder.h"
#include "format/group.h"
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

  // Parses the frames of a group that is not open. With `cut`, `code` may end early: frames whose bytes are missing are
  // then marked as not whole. Returns kCorrupt, with the frame's number, when the code is wrong or no frame is whole;
  // kLimit when the group is larger than the limits.
  Status Parse(const GroupSyntax& group, std::span<const std::uint8_t> code, bool cut, CodedFrames& out) const;
  // Parses the frames of a layered group of which the first layers are there, one at least. What the others would add
  // is left out. Status as of Parse().
  Status ParseLayers(const GroupSyntax& group, std::span<const std::vector<std::uint8_t>> codes,
                     CodedFrames& out) const;
  // Returns how many layers the group may have, its own packet counted. kLimit when the group is larger than the
  // limits.
  Status CountLayers(const GroupSyntax& group, std::size_t& layers) const;

  // Begins an open group, whose frames come one by one to ParseNext().
  void Open(std::uint32_t first_frame);
  Status ParseNext(std::span<const std::uint8_t> code, CodedFrames& out);
  void Close() { open_.reset(); }
  bool is_open() const { return open_.has_value(); }

 private:
  // Checks the size of a group, and that the stream allows its structure.
  Status CheckGroup(const GroupSyntax& group) const;
  Status CheckSize(std::uint32_t frames) const;
  // Parses one layer of a group whose slots are `slots`.
  Status ParseLayer(const GroupLayer& layer, const std::vector<FrameSlot>& slots, std::span<const std::uint8_t> code,
                    FrameCoder<RangeDecoder>& coder, std::vector<bool>& intra) const;
  // Parses a frame with all of its planes or, of a layered group, with those of its own layer.
  Status ParseFrame(const FrameSlot& slot, bool layered, RangeDecoder& range, FrameCoder<RangeDecoder>& coder,
                    bool& intra) const;

  const SequenceHeader& header_;
  const PlaneLayouts& layouts_;
  const std::uint32_t frames_per_group_;
  const std::uint64_t group_values_;
  std::optional<FrameCoder<RangeDecoder>> open_;
  std::uint32_t open_first_ = 0;
};

}  // namespace sac

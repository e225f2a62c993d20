// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "codec/decode/damage_policy.h"
#include "codec/decode/frame_source.h"
#include "codec/decode/group_parser.h"
#include "codec/decode/seek_table.h"
#include "codec/shape.h"
#include "format/sequence_header.h"
#include "sac/decoder.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Takes the packets of a stream's groups, one after another, and gives out their frames. The frames of one group at a
// time wait to be given out. The object counts the frames of the clip and so finds gaps and repetitions.
class GroupSequence {
 public:
  // All references must outlive the object. The memory of the threads is added to that of `shape`. `first_frame` is the
  // number of the frame that comes next in the stream.
  GroupSequence(const SequenceHeader& header, Shape& shape, const DecoderSettings& settings, DamagePolicy& damage,
                std::uint64_t first_frame);

  // Takes a group packet that begins at byte `begin` of the stream, and notes its place in `places`. Returns kCorrupt
  // or kLimit as DamagePolicy judges.
  Status TakeGroup(std::span<const std::uint8_t> payload, std::uint64_t begin, SeekTable& places);
  // Takes a record of the open group. Returns kCorrupt or kLimit as DamagePolicy judges.
  Status TakeFrame(std::span<const std::uint8_t> payload);
  // Takes the whole frames of a group packet that the end of the stream cuts off. The packet's CRC-32 is missing with
  // its end, so the frames are taken only when their numbers fit what is known: the next frame, and `total_frames`.
  void TakeCutPacket(std::span<const std::uint8_t> packet, std::optional<std::uint32_t> total_frames);
  // Checks that the clip ends here with `frames` frames in all. Returns kCorrupt when it does not.
  Status CheckEnd(std::uint32_t frames);
  // Ends the open group, if there is one.
  void CloseGroup() { parser_.Close(); }
  bool GroupIsOpen() const { return parser_.is_open(); }

  // Whether a frame waits.
  bool HasFrame() const { return next_out_ < source_.frames().end(); }
  // Gives the next frame that waits. `shown` gets its number, and stays empty when the frame is not to be shown or is
  // lost. Returns kCorrupt, with the frame's number.
  Status NextFrame(Positions& positions, std::optional<std::uint32_t>& shown);
  // Drops the frames that wait.
  void PassOverFrames() { next_out_ = source_.frames().end(); }

  // Gives the positions at `time`, in frames, between two frames that are held (HoldsAround()). Frames before `time`
  // count as given out. Returns kCorrupt when the positions are not finite.
  Status Interpolate(double time, Positions& positions);
  bool HoldsAround(double time) const;
  // Returns ok when the frames around `time` may still come, kCorrupt when one of them is lost, and kInvalidArgument
  // when the stream is already beyond them.
  Status CanCome(double time) const;
  // Whether `frame` is held and is predicted from no other frame.
  bool IsIntra(std::uint32_t frame) const { return source_.IsIntra(frame); }

  // Goes on with a group that begins with `first_frame`, if that is known; frames before `wanted` are not given.
  void Seek(std::optional<std::uint32_t> first_frame, std::uint32_t wanted);
  // The number of the frame that comes next in the stream; 0 where the stream has been entered.
  std::uint64_t next_frame() const { return next_frame_.value_or(0); }

 private:
  // The packet whose frames source_ has.
  struct HeldGroup {
    std::uint64_t begin;
    std::size_t size;
    std::uint32_t crc;
    bool operator==(const HeldGroup&) const = default;
  };

  // Continues the count with `frame`, and notes the frames that are missing before it as lost.
  Status ContinueAt(std::uint32_t frame);
  Status ReadGroup(const GroupSyntax& group, std::span<const std::uint8_t> code, const HeldGroup& sent);

  const SequenceHeader& header_;
  const DecoderSettings& settings_;
  DamagePolicy& damage_;
  FrameSource source_;  // stands before parser_, which may use the memory that the threads of source_ do not take
  GroupParser parser_;
  bool group_begins_ = false;  // the next record is the first of an open group
  std::optional<HeldGroup> held_;
  std::optional<std::uint64_t>
      next_frame_;              // next frame of the stream; empty after a seek to a group of unknown number
  std::uint64_t next_out_ = 0;  // next of the frames in source_ to be given out
  std::uint64_t wanted_ = 0;    // frames before this one are not given out
};

}  // namespace sac

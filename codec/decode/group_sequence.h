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

// The groups of a stream, one after another: takes their packets and gives their frames, of which one group's wait at a
// time. Keeps count of the frames of the clip, so that gaps and repetitions are found.
class GroupSequence {
 public:
  // All but `first_frame` must outlive the object; `shape` is charged with the memory of the threads. `first_frame` is
  // the number of the frame that comes next.
  GroupSequence(const SequenceHeader& header, Shape& shape, const DecoderSettings& settings, DamagePolicy& damage,
                std::uint64_t first_frame);

  // Takes a group packet that begins at byte `begin` of the stream, and notes its place in `places`. kCorrupt, kLimit.
  Status TakeGroup(std::span<const std::uint8_t> payload, std::uint64_t begin, SeekTable& places);
  // Takes a record of the open group. kCorrupt, kLimit.
  Status TakeFrame(std::span<const std::uint8_t> payload);
  // Takes the frames that are whole in the bytes of a group packet whose rest is missing, as far as they are likely:
  // their check is missing, too. The clip has `total_frames` if it is known.
  void TakeCutPacket(std::span<const std::uint8_t> packet, std::optional<std::uint32_t> total_frames);
  // Checks that the clip ends here with `frames` frames in all. kCorrupt.
  Status CheckEnd(std::uint32_t frames);
  // Ends the open group, if there is one.
  void CloseGroup() { parser_.Close(); }
  bool GroupIsOpen() const { return parser_.is_open(); }

  // Whether a frame waits.
  bool HasFrame() const { return next_out_ < source_.frames().end(); }
  // Gives the next frame that waits; `shown` is empty when that frame is only a step to later ones, or is lost.
  // kCorrupt, with the frame's number.
  Status NextFrame(Positions& positions, std::optional<std::uint32_t>& shown);
  // Drops the frames that wait.
  void PassOverFrames() { next_out_ = source_.frames().end(); }

  // The shape at `time`, in frames, whose frames before and after are held (HoldsAround()). Frames before `time` count
  // as given. kCorrupt.
  Status Interpolate(double time, Positions& positions);
  bool HoldsAround(double time) const;
  // Says why frames around `time` will not come any more, or ok when they may: kCorrupt when one is lost,
  // kInvalidArgument when one is gone.
  Status CanCome(double time) const;
  // Whether a frame that is held needed no other.
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

  // Counts on with `frame`, and loses the frames that are missing before it.
  Status ContinueAt(std::uint32_t frame);
  Status ReadGroup(const GroupSyntax& group, std::span<const std::uint8_t> code, const HeldGroup& sent);

  const SequenceHeader& header_;
  const DecoderSettings& settings_;
  DamagePolicy& damage_;
  FrameSource source_;  // before parser_, which may use the memory that threads leave
  GroupParser parser_;
  bool group_begins_ = false;  // the next record is the first of an open group
  std::optional<HeldGroup> held_;
  std::optional<std::uint64_t> next_frame_;  // of the stream; none where the stream has been entered
  std::uint64_t next_out_ = 0;               // the next of the frames in source_
  std::uint64_t wanted_ = 0;                 // frames before are not given
};

}  // namespace sac

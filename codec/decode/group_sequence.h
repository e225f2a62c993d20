// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/decode/damage_policy.h"
#include "codec/decode/frame_source.h"
#include "codec/decode/group_parser.h"
#include "codec/decode/seek_table.h"
#include "codec/shape.h"
#include "format/sequence_header.h"
#include "sac/decoder.h"
#include "sac/status.h"

namespace sac {

// A group packet, by its place and content.
struct HeldGroup {
  std::uint64_t begin = 0;
  std::size_t size = 0;
  std::uint32_t crc = 0;
  bool operator==(const HeldGroup&) const = default;
};

// A layered group while its layers come.
struct LayeredGroup {
  GroupSyntax group;
  std::vector<std::vector<std::uint8_t>> codes;  // of the layers so far; none any more when the frames are read
  std::size_t next = 1, count = 1;               // number of the next layer, and of those that may come
  std::size_t wanted = 1;                        // layers, the group's own packet counted
  HeldGroup sent;
  std::uint64_t bytes = 0;  // of `codes`
};

// Takes the packets of a stream's groups, one after another, and gives out their frames. The frames of one group at a
// time wait to be given out. The object counts the frames of the clip and so finds gaps and repetitions.
class GroupSequence {
 public:
  // Where decoding is in the clip.
  struct Position {
    std::optional<std::uint64_t> next_frame = 0;  // of the stream; none after a seek to a group of unknown number
    std::uint64_t wanted = 0;                     // frames before this one are not given out
    std::uint32_t layers = 0;                     // the most that a group so far may have
  };

  // All references must outlive the object. The memory of the threads is added to that of `shape`.
  GroupSequence(const SequenceHeader& header, Shape& shape, const DecoderSettings& settings, DamagePolicy& damage,
                const Position& position);
  Position position() const { return {next_frame_, wanted_, layers_}; }

  // Takes a group packet that begins at byte `begin` of the stream, and notes its place in `places`. `group` and `code`
  // are what ParseGroup() made of `payload`. Returns kCorrupt or kLimit as DamagePolicy judges.
  Status TakeGroup(const GroupSyntax& group, std::span<const std::uint8_t> code, std::span<const std::uint8_t> payload,
                   std::uint64_t begin, SeekTable& places);
  // Takes a layer packet. Returns kCorrupt or kLimit as DamagePolicy judges.
  Status TakeLayer(std::span<const std::uint8_t> payload);
  // Whether layers of a group may still come, whose frames wait for them.
  bool WaitsForLayers() const { return layered_ && !layered_->codes.empty(); }
  // Goes on without the layers that have not come.
  Status DoWithoutLayers();
  // Takes a record of the open group. Returns kCorrupt or kLimit as DamagePolicy judges.
  Status TakeFrame(std::span<const std::uint8_t> payload);
  // Takes the whole frames of a group that the end of the stream cuts off. The packet's CRC-32 is missing with its end,
  // so the frames are taken only when their numbers fit what is known: the next frame, and `total_frames`.
  void TakeCutGroup(const GroupSyntax& group, std::span<const std::uint8_t> code,
                    std::optional<std::uint32_t> total_frames);
  // Checks that the clip ends here with `frames` frames in all. Returns kCorrupt when it does not.
  Status CheckEnd(std::uint32_t frames);
  // Ends the open group, if there is one.
  void CloseGroup() { parser_.Close(); }
  bool GroupIsOpen() const { return parser_.is_open(); }

  // Whether a frame waits.
  bool HasFrame() const { return next_out_ < source_.frames().end(); }
  // Gives the next frame that waits. `shown` gets its number, and stays empty when the frame is not to be shown or is
  // lost. Returns kCorrupt, with the frame's number.
  Status NextFrame(FrameOutput& output, std::optional<std::uint32_t>& shown);
  // Drops the frames that wait.
  void PassOverFrames() { next_out_ = source_.frames().end(); }

  // Gives the shape at `time`, in frames, between two frames that are held (HoldsAround()). Frames before `time`
  // count as given out. Returns kCorrupt when the positions are not finite.
  Status Interpolate(double time, FrameOutput& output);
  bool HoldsAround(double time) const;
  bool Holds(std::uint32_t frame) const { return source_.Holds(frame); }
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
  // Continues the count with `frame`, and notes the frames that are missing before it as lost.
  Status ContinueAt(std::uint32_t frame);
  Status ReadGroup(const GroupSyntax& group, std::span<const std::uint8_t> code, const HeldGroup& sent);
  // Begins to hold the layers of a group, whose own packet has the range code `code`.
  Status OpenLayers(std::span<const std::uint8_t> code, const HeldGroup& sent);
  // Holds one more layer, and reads the frames when it is the last that is wanted.
  Status KeepLayer(std::span<const std::uint8_t> code);

  const SequenceHeader& header_;
  const DecoderSettings& settings_;
  DamagePolicy& damage_;
  FrameSource source_;  // stands before parser_, which may use the memory that the threads of source_ do not take
  GroupParser parser_;
  bool group_begins_ = false;      // the next record is the first of an open group
  std::optional<HeldGroup> held_;  // the packet whose frames source_ has
  std::optional<LayeredGroup> layered_;
  std::optional<std::uint64_t> next_frame_;
  std::uint64_t next_out_ = 0;  // next of the frames in source_ to be given out
  std::uint64_t wanted_;
  std::uint32_t layers_;
};

}  // namespace sac

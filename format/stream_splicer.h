// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/group.h"
#include "format/packet.h"
#include "format/sequence_header.h"
#include "format/stream_writer.h"
#include "sac/limits.h"
#include "sac/mesh.h"
#include "sac/metadata.h"
#include "sac/status.h"

namespace sac {

// Frames of a stream by their numbers in it.
struct FrameSpan {
  std::uint64_t begin = 0;
  std::uint64_t end = std::uint64_t{1} << 32;  // the number after the last

  std::uint64_t size() const { return end - begin; }
  bool operator==(const FrameSpan&) const = default;
};

struct SpliceSettings {
  bool index = true;               // of the groups, at the end of a stream of several
  std::uint32_t repeat_start = 0;  // as of StreamWriter
  // Takes streams of the same start in the order given. Otherwise each has to begin with the frame after the last of
  // the stream before, by the numbers that their metadata say (0 where they say none).
  bool renumber = false;
};

// Puts groups of streams together to one stream, without decoding them. Coded frames stay as they are; numbers, starts
// and the index are written anew. A stream that has the start of the one before goes on with its segment, any other
// begins the next. Of metadata those of the first stream count, with the number of the first frame that is taken, and
// the boxes of what is taken where all streams have them; a skippable packet is written once. The bytes are those of an
// encoder that encodes the same groups in one go (but for boxes of groups, which may be larger).
class StreamSplicer {
 public:
  explicit StreamSplicer(const SpliceSettings& settings)
      : settings_(settings), writer_(settings.index, settings.repeat_start) {}

  // Begins the next stream, of which the groups are taken that have frames within `wanted`.
  void Begin(const FrameSpan& wanted = {});
  // Takes bytes of that stream, which may come in any chunking. Returns kCorrupt, kUnsupported or kLimit when its
  // packets are at fault or do not follow each other, and kInvalidArgument when it cannot follow the streams before.
  Status Take(std::span<const std::uint8_t> bytes);
  // Ends it. kCorrupt when it is not complete.
  Status End();
  // Ends the result. kInvalidArgument when no stream had a mesh.
  Status Finish();

  // The bytes of the result since the last call.
  std::vector<std::uint8_t> TakeBytes() { return writer_.TakeBytes(); }

  // Of the stream that was begun last: the frames that it has so far, and which were taken (none where both are equal).
  std::uint64_t frames() const { return in_.frames; }
  const FrameSpan& taken() const { return in_.taken; }
  // Of the result.
  std::uint32_t frames_written() const { return writer_.frames(); }
  std::size_t groups_written() const { return writer_.groups(); }
  // What later streams said of the clip beside the first, and was left out: whether there was such a thing.
  bool dropped_metadata() const { return dropped_metadata_; }

 private:
  struct Start {
    std::vector<std::uint8_t> header, i_frame;  // payloads
    bool operator==(const Start&) const = default;
  };
  // A group that is being read.
  struct Group {
    GroupSyntax syntax;  // of an open group, with the frames that it has so far
    bool open = false;
    std::vector<std::vector<std::uint8_t>> codes;  // of layers, or of an open group's frames
  };
  // The stream that is being read.
  struct Input {
    PacketReader reader{Limits{}};
    FrameSpan wanted;
    FrameSpan taken = {0, 0};
    std::uint64_t frames = 0;
    std::size_t groups = 0;
    std::vector<std::size_t> taken_groups;
    Start start;
    std::optional<Group> group;
    std::vector<Packet> skippable;  // that wait for the next group
    Metadata metadata;
    bool ended = false;
  };

  Status TakePacket(Packet packet);
  Status TakeGroup(const Packet& packet);
  Status TakeLayer(const Packet& packet);
  Status TakeEnd(const Packet& packet);
  void TakeSkippable(Packet packet);
  // Writes the group that has been read, if it is wanted.
  Status PutGroup();
  // What comes before a group: a start, and what waits.
  Status PutStart();
  // Checks that the stream may go on from those before with its frame that the author numbers `number`.
  Status CheckOrder(std::int64_t number) const;
  Status CheckHeader();
  void PutSkippable();
  // Puts the metadata of the clip, whose first frame has another number than in its stream, in the place of its own.
  void RenumberMetadata(std::int64_t number);
  // Notes the boxes of the groups that were taken.
  void TakeBoxes();
  void PutBoxes();

  SpliceSettings settings_;
  StreamWriter writer_;
  Input in_;
  std::size_t inputs_ = 0;
  Start start_;                             // of the segment that is being written
  std::optional<SequenceHeader> first_;     // of the result
  std::optional<std::int64_t> next_frame_;  // the author's number of the frame after those written
  Metadata metadata_;                       // of the first stream
  std::vector<Packet> written_;             // skippable packets
  std::vector<Box> boxes_;                  // of all groups written, or fewer
  std::optional<Box> all_;                  // around all of them
  bool dropped_metadata_ = false;
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/frame_coder.h"
#include "format/group.h"
#include "format/packet.h"
#include "sac/stream_info.h"

namespace sac {

// Joins packets to a stream (spec.md 3) and counts their bytes by what they code.
class StreamWriter {
 public:
  // With `index`, a stream of more than one group ends with an index. Header and I-frame are written again before every
  // `repeat_start`-th group, never when it is 0.
  StreamWriter(bool index, std::uint32_t repeat_start) : wants_index_(index), repeat_start_(repeat_start) {}

  // Begins the stream, or the next segment of it. Not within an open group.
  void Start(std::span<const std::uint8_t> header, std::span<const std::uint8_t> i_frame);
  // Appends a packet of a type that decoders may pass over. Not within an open group.
  void Skippable(PacketType type, std::span<const std::uint8_t> payload);
  // Appends a group of `group.frames` frames. `codes` are the range codes of the group's own packet and of its layers.
  // `bits` are the bits of its planes. The writer sets the numbers of first frame and segment.
  void Group(GroupSyntax group, std::span<const std::vector<std::uint8_t>> codes, const FrameBits& bits);
  // Begins a group whose frames come one by one, until CloseGroup().
  void OpenGroup();
  void Frame(std::span<const std::uint8_t> code, const FrameBits& bits);
  void CloseGroup();
  void End();

  std::uint32_t frames() const { return frames_; }
  std::size_t groups() const { return group_begins_.size(); }
  const StreamBytes& sizes() const { return sizes_; }
  // Returns the bytes that have been written since the last call.
  std::vector<std::uint8_t> TakeBytes();

 private:
  void Append(std::span<const std::uint8_t> more, double StreamBytes::*part);
  // Moves whole bytes of what was appended last from the side information to the planes, as `bits` says.
  void Account(const FrameBits& bits, double side_before);
  void BeginGroup();
  // The number of the segment that groups belong to now.
  std::uint32_t segment() const { return static_cast<std::uint32_t>(segments_.size() - 1); }

  bool wants_index_;
  std::uint32_t repeat_start_;
  std::vector<std::uint8_t> bytes_;
  StreamBytes sizes_;
  std::uint64_t written_ = 0;
  std::vector<std::uint8_t> header_, i_frame_;  // packets
  std::vector<std::uint64_t> group_begins_;
  std::vector<std::uint32_t> group_frames_;
  struct Segment {
    std::size_t first_group;  // index of its first group, or of the next when it has none yet
    std::uint64_t start;      // byte of its sequence header
  };
  std::vector<Segment> segments_;
  std::uint32_t frames_ = 0;
  RecordWriter records_;
};

}  // namespace sac

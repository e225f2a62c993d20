// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/frame_coder.h"
#include "format/group_syntax.h"
#include "format/packet.h"
#include "sac/stream_info.h"

namespace sac {

// Joins packets to a stream (spec.md 3) and counts their bytes by what they code.
class StreamWriter {
 public:
  // With `index`, a stream of more than one group ends with an index. Header and I-frame are written again before every
  // `repeat_start`-th group, never when it is 0.
  StreamWriter(bool index, std::uint32_t repeat_start) : wants_index_(index), repeat_start_(repeat_start) {}

  void Start(std::span<const std::uint8_t> header, std::span<const std::uint8_t> i_frame);
  // Appends a group with the range code `code`. `bits` are the bits of its planes.
  void Group(const GroupSyntax& group, std::span<const std::uint8_t> code, const FrameBits& bits);
  // Begins a group whose frames come one by one, until CloseGroup().
  void OpenGroup();
  void Frame(std::span<const std::uint8_t> code, const FrameBits& bits);
  void CloseGroup();
  void End();

  std::uint32_t frames() const { return frames_; }
  const StreamBytes& sizes() const { return sizes_; }
  // Returns the bytes that have been written since the last call.
  std::vector<std::uint8_t> TakeBytes();

 private:
  void Append(std::span<const std::uint8_t> more, double StreamBytes::*part);
  // Moves whole bytes of what was appended last from the side information to the planes, as `bits` says.
  void Account(const FrameBits& bits, double side_before);
  void BeginGroup();

  bool wants_index_;
  std::uint32_t repeat_start_;
  std::vector<std::uint8_t> bytes_;
  StreamBytes sizes_;
  std::uint64_t written_ = 0;
  std::vector<std::uint8_t> header_, i_frame_;  // packets
  std::vector<std::uint64_t> group_begins_;
  std::vector<std::uint32_t> group_frames_;
  std::uint32_t frames_ = 0;
  RecordWriter records_;
};

}  // namespace sac

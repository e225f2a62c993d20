#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/frame_coder.h"
#include "format/group_syntax.h"
#include "format/packet.h"
#include "sac/stream_info.h"

namespace sac {

// Puts packets together to a stream (spec.md 3), and keeps account of them.
class StreamWriter {
 public:
  // `index`: ends the stream with an index, if it has more than one group. `repeat_start`: writes header and I-frame
  // again before every so many groups; 0: never.
  StreamWriter(bool index, std::uint32_t repeat_start) : wants_index_(index), repeat_start_(repeat_start) {}

  void Start(std::span<const std::uint8_t> header, std::span<const std::uint8_t> i_frame);
  // A group's code, of which `bits` say what belongs to the planes.
  void Group(const GroupSyntax& group, std::span<const std::uint8_t> code, const FrameBits& bits);
  // A group whose frames come one by one.
  void OpenGroup();
  void Frame(std::span<const std::uint8_t> code, const FrameBits& bits);
  void CloseGroup();
  void End();

  std::uint32_t frames() const { return frames_; }
  const StreamBytes& sizes() const { return sizes_; }
  // What has been written since the last call.
  std::vector<std::uint8_t> TakeBytes();

 private:
  void Append(std::span<const std::uint8_t> more, double StreamBytes::*part);
  // Whole bytes for the planes of what was appended last, the rest stays side information.
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

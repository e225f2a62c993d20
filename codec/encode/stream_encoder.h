// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "codec/encode/encoded_start.h"
#include "codec/encode/group_encoder.h"
#include "format/frame_coder.h"
#include "format/stream_writer.h"
#include "sac/encoder.h"
#include "sac/mesh.h"
#include "sac/status.h"
#include "sac/stream_info.h"

namespace sac {

// Encodes the frames of one stream, group after group. The functions are those of Encoder, where they are documented.
// They may throw std::bad_alloc, which leaves a frame or group half coded: call Latch() then.
class StreamEncoder {
 public:
  // Begins a stream with `start`. Of `settings`, which CheckSettings() has passed, only what concerns groups is used:
  // group, pyramid, low_delay, index, repeat_start, limits and progress.
  StreamEncoder(EncodedStart start, const EncoderSettings& settings);
  StreamEncoder(const StreamEncoder&) = delete;
  StreamEncoder& operator=(const StreamEncoder&) = delete;

  Status Send(std::span<const Vec3f> positions);
  // Ends the group and goes on with frames of `start`, as the next segment.
  Status BeginSegment(EncodedStart start);
  Status Finish();
  std::vector<std::uint8_t> TakeBytes() { return writer_.TakeBytes(); }

  // Makes a failure final, after which nothing can be coded.
  Status Latch(Status status) {
    if (!status.ok()) failure_ = status;
    return status;
  }

  const std::vector<std::uint32_t>& order() const { return start_.order; }
  const StreamInfo& info() const { return info_; }
  const StreamBytes& stream_bytes() const { return writer_.sizes(); }
  std::uint32_t frames() const { return writer_.frames(); }
  std::optional<FrameFault> fault() const { return fault_; }

 private:
  // Keeps `status`, when it is a failure of the frame whose index in the stream and whose vertex in the input are
  // given, and returns it with both in its message.
  Status AtFault(Status status, std::uint32_t frame, std::optional<std::uint32_t> vertex);
  // The same for a failure of the group encoder, whose group begins with frame `first`.
  Status AtFault(Status status, std::uint32_t first);

  // Finds inputs_ and begins to code frames of start_.
  void Begin();
  // Checks that vertices which are joined coincide in the frame.
  Status CheckJoined(std::span<const Vec3f> positions, std::uint32_t frame);
  // Whether a group of `frames` frames can take no further frame.
  bool IsFull(std::uint32_t frames) const;
  // Tells the caller that `frames` frames are coded. Returns kCancelled when the caller wants to stop.
  Status Progress(std::uint32_t frames) const {
    return settings_.progress && !settings_.progress(frames) ? Status::Cancelled() : Status::Ok();
  }
  // Codes the waiting frames as a group.
  Status EncodeGroup();
  // The range codes of a group's frames, one for each layer. `group` has the number of frames and the structure.
  Status CodeLayers(const GroupSyntax& group, const std::vector<FrameSlot>& structure, std::vector<FrameSyntax>& coded,
                    FrameBits& bits, std::vector<std::vector<std::uint8_t>>& codes);
  // Notes that the frames of a group lie within `positions`.
  void AddBounds(std::span<const Vec3f> positions);
  // Writes the bounds of the clip and its groups.
  void WriteBounds();
  // Codes a frame of an open group (low delay). Takes the positions in decoded order, model units.
  Status EncodeFrame(PositionMatrix positions);
  void EndOpenGroup();

  EncodedStart start_;
  std::vector<std::uint32_t> inputs_;  // of each coded vertex the first of those in the input
  const EncoderSettings settings_;
  StreamInfo info_;
  std::optional<GroupEncoder> encoder_;  // refers to start_
  StreamWriter writer_;
  std::vector<Box> group_boxes_;         // of the input's positions, when the settings want bounds
  std::vector<PositionMatrix> waiting_;  // frames that wait for the group to be full
  bool finished_ = false;

  // The open group, with low delay.
  std::optional<FrameCoder<RangeEncoder>> coder_;
  std::uint32_t open_frames_ = 0;
  Status failure_;
  std::optional<FrameFault> fault_;
};

}  // namespace sac

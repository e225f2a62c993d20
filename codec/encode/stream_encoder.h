// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "codec/encode/encoded_start.h"
#include "codec/encode/group_encoder.h"
#include "codec/encode/group_window.h"
#include "codec/encode/projection.h"
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
  // Begins a stream with `start`. Of `settings`, which CheckSettings() has passed, only what does not concern shapes
  // and the structure of groups is used: low_delay, index, repeat_start, metadata, limits, threads, run_jobs and
  // progress.
  StreamEncoder(EncodedStart start, const EncoderSettings& settings);
  StreamEncoder(const StreamEncoder&) = delete;
  StreamEncoder& operator=(const StreamEncoder&) = delete;

  Status Send(std::span<const Vec3f> positions);
  // Ends the group and goes on with frames of `start`, as the next segment.
  Status BeginSegment(EncodedStart start);
  // Codes the groups that wait for others to be coded at the same time.
  Status Flush();
  Status Finish();
  std::vector<std::uint8_t> TakeBytes() { return writer_.TakeBytes(); }

  // Makes a failure final, after which nothing can be coded.
  Status Latch(Status status) {
    if (!status.ok()) failure_ = status;
    return status;
  }

  const EncodedStart& start() const { return start_; }
  // How many frames a full group has.
  std::uint32_t full_group() const { return full_group_; }
  const std::vector<std::uint32_t>& order() const { return start_.order; }
  const StreamInfo& info() const { return info_; }
  const StreamBytes& stream_bytes() const { return writer_.sizes(); }
  std::uint32_t frames() const { return writer_.frames(); }
  std::optional<FrameFault> fault() const { return fault_; }

 private:
  // Keeps `status`, when it is a failure of the frame whose index in the stream and whose vertex in the input are
  // given, and returns it with both in its message.
  Status AtFault(Status status, std::uint32_t frame, std::optional<std::uint32_t> vertex);
  // The same for what is wrong with the next frame itself, if those before can be coded.
  Status Refuse(Status status, std::optional<std::uint32_t> vertex = {});
  // Finds inputs_, writes start_ and makes what codes its groups.
  void BeginGroups();
  // Checks that vertices which are joined coincide in the next frame.
  Status CheckJoined(std::span<const Vec3f> positions);
  // Tells the caller that `frames` frames are coded. Returns kCancelled when the caller wants to stop.
  Status Progress(std::uint32_t frames) const {
    return settings_.progress && !settings_.progress(frames) ? Status::Cancelled() : Status::Ok();
  }
  // Codes and writes the groups of the window.
  Status EncodeGroups();
  // Ends the last group of a segment and writes what there is.
  Status EndGroups();
  // Notes that the frames of a group lie within `positions`.
  void AddBounds(std::span<const Vec3f> positions);
  // Writes the bounds of the clip and its groups.
  void WriteBounds();
  // Codes a frame of an open group (low delay). Takes the positions in decoded order, model units.
  Status EncodeFrame(Positions positions);
  void EndOpenGroup();

  EncodedStart start_;
  std::vector<std::uint32_t> inputs_;  // of each coded vertex the first of those in the input
  const EncoderSettings settings_;
  StreamInfo info_;
  std::unique_ptr<const Projection> projection_;  // of start_, as what follows
  std::optional<GroupWindow> window_;             // without low delay
  std::optional<GroupEncoder> chain_;             // with low delay
  std::uint32_t full_group_ = 0;                  // frames of a group that can take no more
  StreamWriter writer_;
  std::vector<Box> group_boxes_;    // of the input's positions, when the settings want bounds
  std::vector<Positions> waiting_;  // frames that wait for the group to be full, in decoded order
  bool finished_ = false;

  // The open group, with low delay.
  std::optional<FrameCoder<RangeEncoder>> coder_;
  std::uint32_t open_frames_ = 0;
  Status failure_;
  std::optional<FrameFault> fault_;
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
// How a StreamDecoder goes to other frames and to times between frames.
#include <algorithm>
#include <cmath>
#include <string>

#include "codec/decode/stream_decoder.h"
#include "format/stream_index.h"

namespace sac {

Status StreamDecoder::Seek(std::uint32_t frame, std::uint64_t& byte) {
  if (!start_.mesh()) return Status::NeedMoreData();
  if (total_frames_ && frame >= *total_frames_) return BeyondTheEnd(frame);
  if (!groups_) SAC_RETURN_IF_ERROR(PrepareGroups());
  const SeekTable::Place place = places_.Find(frame, start_.segment());
  byte = place.byte;
  packets_.Restart(byte);
  start_.Restart();
  held_packet_.reset();
  groups_->Seek(place.first_frame, frame);
  error_.reset();
  ended_ = finished_ = false;
  return Status::Ok();
}

Status StreamDecoder::SeekTime(double seconds, std::uint64_t& byte) {
  const std::optional<SequenceHeader>& header = start_.header();
  if (!header) return Status::NeedMoreData();
  if (header->frame_rate_numerator == 0) return Status::InvalidArgument("the stream has no frame rate");
  const double time = seconds * header->frames_per_second();
  // A seek to the time that a frame was given out with must find that frame, although the time was rounded.
  const double frame = std::floor(time + 1e-9 + 4e-16 * time);
  if (!(frame >= 0 && frame <= 0xffffffffu)) return Status::InvalidArgument("a time that is no frame's");
  return Seek(static_cast<std::uint32_t>(frame), byte);
}

Status StreamDecoder::AddIndex(std::span<const std::uint8_t> tail, std::size_t& needed) {
  StreamIndex index;
  SAC_RETURN_IF_ERROR(ReadIndex(tail, settings_.limits, index, needed));
  places_.Take(index);
  total_frames_ = 0;
  for (const StreamIndex::Group& group : index.groups) *total_frames_ += group.frames;
  return Status::Ok();
}

template <class CheckOutput>
Status StreamDecoder::At(double& time, const CheckOutput& check, FrameOutput& output) {
  if (error_) return *error_;
  if (!(time >= 0 && time <= 0xfffffffeu)) return Status::InvalidArgument("a time that is no frame's");
  if (!start_.mesh()) return Status::NeedMoreData();
  if (!groups_) SAC_RETURN_IF_ERROR(Latch(PrepareGroups()));
  SAC_RETURN_IF_ERROR(check());
  if (start_.header()->references_previous()) {
    return Status::Unsupported("frames measured against the frame before have none between");
  }
  if (total_frames_ && time >= *total_frames_) return BeyondTheEnd(time);
  if (total_frames_) time = std::min(time, *total_frames_ - 1.0);  // the last frame is held for its time
  SAC_RETURN_IF_ERROR(ReadAround(time));
  SAC_RETURN_IF_ERROR(check());  // again, because the mesh may be another one now
  return groups_->Interpolate(time, output);
}

Status StreamDecoder::Interpolate(double time, Positions& positions, FrameInfo& info, const FrameBuffers* buffers) {
  FrameOutput output{&positions};
  SAC_RETURN_IF_ERROR(At(
      time, [&] { return Check(buffers); }, output));
  GiveOut(static_cast<std::uint32_t>(time), time, positions, info, buffers);
  return Status::Ok();
}

Status StreamDecoder::InterpolateHandles(double time, std::span<float> matrices, FrameInfo& info, bool& exact) {
  FrameOutput output;
  SAC_RETURN_IF_ERROR(At(
      time, [&] { return CheckHandles(matrices); }, output));
  Describe(static_cast<std::uint32_t>(time), time, info);
  info.box = handles_->Fill(*output.blend, matrices);
  exact = output.exact;
  return Status::Ok();
}

Status StreamDecoder::ReadAround(double& time) {
  while (!groups_ || !groups_->HoldsAround(time)) {
    if (groups_ && start_.MeshEnds() && groups_->Holds(static_cast<std::uint32_t>(time)) &&
        groups_->next_frame() == static_cast<std::uint64_t>(time) + 1) {
      time = std::floor(time);
      return Status::Ok();
    }
    SAC_RETURN_IF_ERROR(groups_ ? groups_->CanCome(time) : Status::Ok());
    if (!groups_) return Status::NeedMoreData();
    groups_->PassOverFrames();
    if (CanAdvance()) {
      SAC_RETURN_IF_ERROR(AdvanceAlone());
    } else if (ended_ || finished_) {
      const auto frame = static_cast<std::uint32_t>(time);
      return Status::InvalidArgument("frame " + std::to_string(frame) + " or the next is not there");
    } else {
      return Status::NeedMoreData();
    }
  }
  return Status::Ok();
}

Status StreamDecoder::BeyondTheEnd(double time) const {
  return Status::InvalidArgument("frame " + std::to_string(static_cast<std::uint32_t>(time)) + " of a clip of " +
                                 std::to_string(*total_frames_) + " frames");
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/stream_encoder.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "codec/encode/input_check.h"
#include "format/group.h"
#include "format/metadata.h"
#include "geometry/bounding_box.h"

namespace sac {
namespace {

// The rows `inputs` of `positions`, one for each coded vertex.
Positions InDecodedOrder(std::span<const Vec3f> positions, const std::vector<std::uint32_t>& inputs) {
  Positions ordered(inputs.size());
  for (std::size_t v = 0; v < inputs.size(); ++v) ordered[v] = positions[inputs[v]];
  return ordered;
}

}  // namespace

StreamEncoder::StreamEncoder(EncodedStart start, const EncoderSettings& settings)
    : start_(std::move(start)),
      settings_(settings),
      info_(InfoOf(start_.header)),
      writer_(settings.index, settings.repeat_start) {
  BeginGroups();
  if (!settings.metadata.empty()) writer_.Skippable(PacketType::kMetadata, WriteMetadata(settings.metadata));
  for (const ExtraPacket& packet : settings.extra_packets) {
    writer_.Skippable(static_cast<PacketType>(packet.type), packet.payload);
  }
}

Status StreamEncoder::AtFault(Status status, std::uint32_t frame, std::optional<std::uint32_t> vertex) {
  if (status.code() != StatusCode::kInvalidArgument) return status;
  fault_ = {frame, vertex};
  return Status::InvalidArgument("frame " + std::to_string(frame) +
                                 (vertex ? ", vertex " + std::to_string(*vertex) : std::string()) + ": " +
                                 status.message());
}

void StreamEncoder::BeginGroups() {
  inputs_ = start_.order;
  if (const std::vector<std::uint32_t>& vertex_of_copy = start_.shape.vertex_of_copy; !vertex_of_copy.empty()) {
    inputs_.assign(start_.header.vertices, static_cast<std::uint32_t>(vertex_of_copy.size()));
    for (std::size_t i = 0; i < vertex_of_copy.size(); ++i) {
      std::uint32_t& input = inputs_[vertex_of_copy[i]];
      input = std::min(input, start_.order[i]);
    }
  }
  window_.reset();
  chain_.reset();
  projection_ = ProjectionOf(start_.shape);
  full_group_ = FullGroup(start_, settings_.limits);
  if (settings_.low_delay) {
    chain_.emplace(start_.shape, start_.header, start_.max_error, *projection_);
  } else {
    window_.emplace(start_, *projection_, settings_);
  }
  writer_.Start(WriteSequenceHeader(start_.header), start_.i_frame);
}

Status StreamEncoder::CheckJoined(std::span<const Vec3f> positions) {
  const std::vector<std::uint32_t>& vertex_of_copy = start_.shape.vertex_of_copy;
  for (std::size_t i = 0; i < vertex_of_copy.size(); ++i) {
    const std::uint32_t copy = start_.order[i], joined = inputs_[vertex_of_copy[i]];
    if (positions[copy] == positions[joined]) continue;
    return Refuse(Status::InvalidArgument("parts from vertex " + std::to_string(joined) + ", which it is joined with"),
                  copy);
  }
  return Status::Ok();
}

Status StreamEncoder::Send(std::span<const Vec3f> positions) {
  if (finished_) return Status::InvalidArgument("the stream is finished");
  SAC_RETURN_IF_ERROR(failure_);
  if (positions.size() != start_.order.size()) {
    return Refuse(Status::InvalidArgument(std::to_string(positions.size()) + " vertices, expected " +
                                          std::to_string(start_.order.size())));
  }
  if (Status status = CheckFinite(positions); !status.ok()) return Refuse(std::move(status));
  SAC_RETURN_IF_ERROR(CheckJoined(positions));
  if (settings_.bounds) AddBounds(positions);
  Positions ordered = InDecodedOrder(positions, inputs_);
  if (settings_.low_delay) return Latch(EncodeFrame(std::move(ordered)));
  waiting_.push_back(std::move(ordered));
  if (waiting_.size() < full_group_) return Status::Ok();
  window_->Add(std::exchange(waiting_, {}), true);
  return window_->IsFull() ? Latch(EncodeGroups()) : Status::Ok();
}

Status StreamEncoder::Refuse(Status status, std::optional<std::uint32_t> vertex) {
  SAC_RETURN_IF_ERROR(Flush());  // a frame before may be at fault
  return AtFault(std::move(status), writer_.frames() + static_cast<std::uint32_t>(waiting_.size()), vertex);
}

Status StreamEncoder::Flush() {
  SAC_RETURN_IF_ERROR(failure_);
  return window_ ? Latch(EncodeGroups()) : Status::Ok();
}

Status StreamEncoder::EncodeFrame(Positions positions) {
  if (open_frames_ == 0) {
    writer_.OpenGroup();
    coder_.emplace(start_.header, start_.shape.layouts);
  }
  FrameSyntax frame;
  if (Status status = chain_->EncodeNext(std::move(positions), open_frames_, frame); !status.ok()) {
    return AtFault(std::move(status), writer_.frames() - open_frames_ + chain_->failed_frame(),
                   inputs_[chain_->failed_vertex()]);
  }
  RangeEncoder range;  // a coder of its own, since each frame is a record; the models in coder_ continue
  FrameBits bits;
  if (!coder_->Code(range, ChainSlot(open_frames_), frame, &bits)) return AtFault(MotionTooFar(), writer_.frames(), {});
  writer_.Frame(range.Finish(), bits);
  if (++open_frames_ >= full_group_) EndOpenGroup();
  return Progress(writer_.frames());
}

void StreamEncoder::EndOpenGroup() {
  if (open_frames_ > 0) writer_.CloseGroup();
  open_frames_ = 0;
}

Status StreamEncoder::EncodeGroups() {
  if (window_->empty()) return Status::Ok();
  const std::uint32_t before = writer_.frames();
  const auto progress = [&](std::uint32_t count) { return !settings_.progress || settings_.progress(before + count); };
  std::vector<ClosedGroup> groups;
  if (Status status = window_->Encode(progress, groups); !status.ok()) {
    waiting_.clear();
    return status;
  }
  for (ClosedGroup& group : groups) {
    if (!group.status.ok()) {
      waiting_.clear();
      std::optional<std::uint32_t> vertex;
      if (group.failed_vertex) vertex = inputs_[*group.failed_vertex];
      return AtFault(std::move(group.status), writer_.frames() + group.failed_frame, vertex);
    }
    writer_.Group(group.syntax, group.codes, group.bits);
  }
  return Status::Ok();
}

Status StreamEncoder::EndGroups() {
  EndOpenGroup();
  if (!window_) return Status::Ok();
  if (!waiting_.empty()) window_->Add(std::exchange(waiting_, {}), false);
  return Latch(EncodeGroups());
}

Status StreamEncoder::BeginSegment(EncodedStart start) {
  if (finished_) return Status::InvalidArgument("the stream is finished");
  SAC_RETURN_IF_ERROR(failure_);
  SAC_RETURN_IF_ERROR(EndGroups());
  window_.reset();
  chain_.reset();
  start_ = std::move(start);
  info_ = InfoOf(start_.header);
  BeginGroups();
  return Status::Ok();
}

void StreamEncoder::AddBounds(std::span<const Vec3f> positions) {
  const std::size_t group = writer_.groups() - (open_frames_ > 0 ? 1 : 0) + (window_ ? window_->size() : 0);
  const Box box = BoundingBox(positions);
  if (group_boxes_.size() == group) {
    group_boxes_.push_back(box);
  } else {
    group_boxes_.back() = Union(group_boxes_.back(), box);
  }
}

void StreamEncoder::WriteBounds() {
  group_boxes_.resize(std::min(group_boxes_.size(), writer_.groups()));  // without those that could not be coded
  if (group_boxes_.empty()) return;
  Metadata metadata;
  Box bounds = group_boxes_.front();
  for (const Box& box : group_boxes_) bounds = Union(bounds, box);
  metadata.bounds = bounds;
  if (group_boxes_.size() > 1) {
    for (const Box& box : group_boxes_) metadata.group_bounds.push_back(InBounds(box, bounds));
  }
  writer_.Skippable(PacketType::kMetadata, WriteMetadata(metadata));
}

Status StreamEncoder::Finish() {
  if (finished_) return Status::InvalidArgument("the stream is finished");
  // After a frame that cannot be coded the stream ends with what was complete before it.
  const bool ends_early = failure_.code() == StatusCode::kInvalidArgument && writer_.frames() > 0;
  if (!ends_early) SAC_RETURN_IF_ERROR(failure_);
  SAC_RETURN_IF_ERROR(EndGroups());
  WriteBounds();
  writer_.End();
  finished_ = true;
  return Status::Ok();
}

}  // namespace sac

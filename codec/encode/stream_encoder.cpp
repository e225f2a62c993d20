// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/stream_encoder.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "codec/encode/input_check.h"
#include "format/group.h"
#include "format/metadata.h"
#include "geometry/bounding_box.h"

namespace sac {
namespace {

// The rows `inputs` of `positions`, one for each coded vertex.
PositionMatrix InDecodedOrder(std::span<const Vec3f> positions, const std::vector<std::uint32_t>& inputs) {
  PositionMatrix ordered(static_cast<Eigen::Index>(inputs.size()), 3);
  for (std::size_t v = 0; v < inputs.size(); ++v) {
    const Vec3f& p = positions[inputs[v]];
    ordered.row(static_cast<Eigen::Index>(v)) << static_cast<double>(p[0]), static_cast<double>(p[1]),
        static_cast<double>(p[2]);
  }
  return ordered;
}

}  // namespace

StreamEncoder::StreamEncoder(EncodedStart start, const EncoderSettings& settings)
    : start_(std::move(start)),
      settings_(settings),
      info_(InfoOf(start_.header)),
      writer_(settings.index, settings.repeat_start) {
  Begin();
  if (!settings.metadata.empty()) writer_.Skippable(PacketType::kMetadata, WriteMetadata(settings.metadata));
  for (const ExtraPacket& packet : settings.extra_packets) {
    writer_.Skippable(static_cast<PacketType>(packet.type), packet.payload);
  }
}

void StreamEncoder::Begin() {
  inputs_ = start_.order;
  if (const std::vector<std::uint32_t>& vertex_of_copy = start_.shape.vertex_of_copy; !vertex_of_copy.empty()) {
    inputs_.assign(start_.header.vertices, static_cast<std::uint32_t>(vertex_of_copy.size()));
    for (std::size_t i = 0; i < vertex_of_copy.size(); ++i) {
      std::uint32_t& input = inputs_[vertex_of_copy[i]];
      input = std::min(input, start_.order[i]);
    }
  }
  encoder_.emplace(start_.shape, start_.header, start_.max_error);
  writer_.Start(WriteSequenceHeader(start_.header), start_.i_frame);
}

Status StreamEncoder::AtFault(Status status, std::uint32_t frame, std::optional<std::uint32_t> vertex) {
  if (status.code() != StatusCode::kInvalidArgument) return status;
  fault_ = {frame, vertex};
  return Status::InvalidArgument("frame " + std::to_string(frame) +
                                 (vertex ? ", vertex " + std::to_string(*vertex) : std::string()) + ": " +
                                 status.message());
}

Status StreamEncoder::AtFault(Status status, std::uint32_t first) {
  return AtFault(std::move(status), first + encoder_->failed_frame(), inputs_[encoder_->failed_vertex()]);
}

Status StreamEncoder::CheckJoined(std::span<const Vec3f> positions, std::uint32_t frame) {
  const std::vector<std::uint32_t>& vertex_of_copy = start_.shape.vertex_of_copy;
  for (std::size_t i = 0; i < vertex_of_copy.size(); ++i) {
    const std::uint32_t copy = start_.order[i], joined = inputs_[vertex_of_copy[i]];
    if (positions[copy] == positions[joined]) continue;
    return AtFault(Status::InvalidArgument("parts from vertex " + std::to_string(joined) + ", which it is joined with"),
                   frame, copy);
  }
  return Status::Ok();
}

Status StreamEncoder::Send(std::span<const Vec3f> positions) {
  if (finished_) return Status::InvalidArgument("the stream is finished");
  SAC_RETURN_IF_ERROR(failure_);
  const auto frame = writer_.frames() + static_cast<std::uint32_t>(waiting_.size());
  if (positions.size() != start_.order.size()) {
    return AtFault(Status::InvalidArgument(std::to_string(positions.size()) + " vertices, expected " +
                                           std::to_string(start_.order.size())),
                   frame, std::nullopt);
  }
  SAC_RETURN_IF_ERROR(AtFault(CheckFinite(positions), frame, std::nullopt));
  SAC_RETURN_IF_ERROR(CheckJoined(positions, frame));
  if (settings_.bounds) AddBounds(positions);
  PositionMatrix ordered = InDecodedOrder(positions, inputs_);
  if (settings_.low_delay) return Latch(EncodeFrame(std::move(ordered)));
  waiting_.push_back(std::move(ordered));
  return IsFull(static_cast<std::uint32_t>(waiting_.size())) ? Latch(EncodeGroup()) : Status::Ok();
}

// A group is full when it has the number of frames of the settings or one more would exceed the decoders' limits.
bool StreamEncoder::IsFull(std::uint32_t frames) const {
  return frames == settings_.group || (std::uint64_t{frames} + 1) * FrameValues(start_.shape.layouts) >
                                          MaxGroupValues(settings_.limits, start_.shape);
}

Status StreamEncoder::EncodeFrame(PositionMatrix positions) {
  if (open_frames_ == 0) {
    writer_.OpenGroup();
    coder_.emplace(start_.header, start_.shape.layouts);
  }
  FrameSyntax frame;
  SAC_RETURN_IF_ERROR(
      AtFault(encoder_->EncodeNext(std::move(positions), open_frames_, frame), writer_.frames() - open_frames_));
  RangeEncoder range;  // a coder of its own, since each frame is a record; the models in coder_ continue
  FrameBits bits;
  if (!coder_->Code(range, ChainSlot(open_frames_), frame, &bits)) return AtFault(MotionTooFar(), writer_.frames(), {});
  writer_.Frame(range.Finish(), bits);
  if (IsFull(++open_frames_)) EndOpenGroup();
  return Progress(writer_.frames());
}

void StreamEncoder::EndOpenGroup() {
  if (open_frames_ > 0) writer_.CloseGroup();
  open_frames_ = 0;
}

Status StreamEncoder::EncodeGroup() {
  GroupSyntax group;
  group.frames = static_cast<std::uint32_t>(waiting_.size());
  // A pyramid larger than the group is as one of its size.
  group.pyramid = start_.header.references_previous() ? 1 : std::min(settings_.pyramid, group.frames);
  group.base_levels = start_.header.references_previous() ? 0 : settings_.base_levels;
  std::vector<FrameSlot> structure = GroupStructure(group.frames, group.pyramid);
  if (group.layered()) structure = LayeredOrder(structure, group.base_levels);
  const std::uint32_t before = writer_.frames();
  const auto frame_done = [&](std::uint32_t count) { return Progress(before + count); };
  std::vector<FrameSyntax> coded;
  SAC_RETURN_IF_ERROR(AtFault(encoder_->Encode(std::exchange(waiting_, {}), structure, frame_done, coded), before));
  FrameBits bits;
  std::vector<std::vector<std::uint8_t>> codes;
  SAC_RETURN_IF_ERROR(CodeLayers(group, structure, coded, bits, codes));
  writer_.Group(group, codes, bits);
  return Status::Ok();
}

Status StreamEncoder::CodeLayers(const GroupSyntax& group, const std::vector<FrameSlot>& structure,
                                 std::vector<FrameSyntax>& coded, FrameBits& bits,
                                 std::vector<std::vector<std::uint8_t>>& codes) {
  FrameCoder<RangeEncoder> coder(start_.header, start_.shape.layouts);
  std::vector<GroupLayer> layers = {{0, structure.size(), kMotion}};
  if (group.layered()) layers = LayersOf(structure, group.base_levels, start_.shape.layouts);
  for (const GroupLayer& layer : layers) {
    RangeEncoder range;
    for (std::size_t i = layer.first; i < layer.end; ++i) {
      FrameSyntax& frame = coded[i];
      const bool good = !group.layered()     ? coder.Code(range, structure[i], frame, &bits)
                        : layer.has_frames() ? coder.CodeBase(range, structure[i], frame, &bits)
                                             : coder.CodeLater(range, i, layer.plane, frame, &bits);
      if (!good) return AtFault(MotionTooFar(), writer_.frames() + structure[i].display, {});
    }
    codes.push_back(range.Finish());
  }
  return Status::Ok();
}

Status StreamEncoder::BeginSegment(EncodedStart start) {
  if (finished_) return Status::InvalidArgument("the stream is finished");
  SAC_RETURN_IF_ERROR(failure_);
  EndOpenGroup();
  if (!waiting_.empty()) SAC_RETURN_IF_ERROR(Latch(EncodeGroup()));
  encoder_.reset();
  start_ = std::move(start);
  info_ = InfoOf(start_.header);
  Begin();
  return Status::Ok();
}

void StreamEncoder::AddBounds(std::span<const Vec3f> positions) {
  const std::size_t group = writer_.groups() - (open_frames_ > 0 ? 1 : 0);
  const Box box = BoundingBox(positions);
  if (group_boxes_.size() == group) {
    group_boxes_.push_back(box);
  } else {
    group_boxes_.back() = Union(group_boxes_.back(), box);
  }
}

void StreamEncoder::WriteBounds() {
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
  EndOpenGroup();
  if (!waiting_.empty()) SAC_RETURN_IF_ERROR(Latch(EncodeGroup()));
  WriteBounds();
  writer_.End();
  finished_ = true;
  return Status::Ok();
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/stream_decoder.h"

#include <algorithm>
#include <string>
#include <utility>

#include "format/bytes.h"
#include "format/group.h"
#include "format/metadata.h"
#include "format/stream_index.h"
#include "geometry/bounding_box.h"

namespace sac {

StreamDecoder::StreamDecoder(const DecoderSettings& settings)
    : settings_(settings),
      damage_(settings.skip_damage),
      packets_(settings.limits, settings.skip_damage),
      start_(settings.limits, damage_) {}

Status StreamDecoder::Send(std::span<const std::uint8_t>& bytes) {
  if (error_) return *error_;
  if (FrameWaits()) return Status::Ok();
  return Latch(Advance(bytes));
}

Status StreamDecoder::Advance(std::span<const std::uint8_t>& bytes) {
  if (ended_) {
    Status status = bytes.empty() ? Status::Ok() : damage_.Judge(Status::Corrupt("bytes after the end of the stream"));
    if (status.ok()) bytes = {};
    return status;
  }
  if (held_packet_) {
    const HeldPacket held = std::move(*std::exchange(held_packet_, std::nullopt));
    return Take(held.packet, held.begin);
  }
  std::optional<Packet> packet;
  bool damaged = false;
  SAC_RETURN_IF_ERROR(packets_.Read(bytes, packet, damaged));
  if (damaged && groups_) groups_->CloseGroup();
  if (!packet) return Status::Ok();
  const std::uint64_t size = std::min<std::uint64_t>(PacketSize(packet->payload.size()), packets_.position());
  const std::uint64_t begin = packets_.position() - size;
  if (groups_ && groups_->WaitsForLayers() && packet->type != PacketType::kLayer && !IsSkippable(packet->type)) {
    held_packet_ = {std::move(*packet), begin};
    return groups_->DoWithoutLayers();
  }
  return Take(*packet, begin);
}

Status StreamDecoder::Take(const Packet& packet, std::uint64_t begin) {
  SAC_RETURN_IF_ERROR(start_.CheckOrder(packet.type));
  switch (packet.type) {
    case PacketType::kHeader:
    case PacketType::kIFrame:
      return TakeStart(packet, begin);
    case PacketType::kGroup:
      return TakeGroup(packet.payload, begin);
    case PacketType::kLayer:
      return groups_ ? groups_->TakeLayer(packet.payload)
                     : damage_.Judge(Status::Corrupt("a layer that follows no group"));
    case PacketType::kFrame:
      return groups_ ? groups_->TakeFrame(packet.payload) : Status::Ok();
    case PacketType::kGroupEnd:
      if (groups_) groups_->CloseGroup();
      return Status::Ok();
    case PacketType::kEnd:
      return TakeEnd(packet.payload, begin);
    default:
      TakeSkippable(packet);
      return Status::Ok();
  }
}

Status StreamDecoder::TakeStart(const Packet& packet, std::uint64_t begin) {
  if (packet.type == PacketType::kHeader) {
    start_begin_ = begin;
    return start_.TakeHeader(packet.payload);
  }
  const bool is_first = packets_.from_start() && !start_.mesh();
  SAC_RETURN_IF_ERROR(start_.TakeIFrame(packet.payload, is_first));
  places_.AddStart(start_begin_, packets_.position(), is_first);
  return Status::Ok();
}

void StreamDecoder::TakeSkippable(const Packet& packet) {
  if (settings_.skippable) settings_.skippable(static_cast<std::uint32_t>(packet.type), packet.payload);
  if (packet.type != PacketType::kMetadata) return;
  Metadata metadata = metadata_.value_or(Metadata{});
  if (ParseMetadata(packet.payload, metadata).ok()) metadata_ = std::move(metadata);
}

Status StreamDecoder::TakeGroup(std::span<const std::uint8_t> payload, std::uint64_t begin) {
  if (!start_.mesh()) return damage_.Judge(Status::Corrupt("a group before the I-frame"));
  if (groups_) groups_->CloseGroup();  // records that follow a group passed over are not the open group's before
  GroupSyntax group;
  std::span<const std::uint8_t> code;
  if (Status status = ParseGroup(payload, group, code); !status.ok()) return damage_.Judge(std::move(status));
  Status status = start_.CheckSegment(group.segment);
  if (status.ok()) status = PrepareGroups();
  if (!status.ok()) {
    const std::uint64_t given = groups_ ? groups_->next_frame() : 0,
                        end = std::uint64_t{group.first_frame} + group.frames;
    return damage_.Judge(std::move(status), std::min(end, std::max<std::uint64_t>(group.first_frame, given)), end);
  }
  return groups_->TakeGroup(group, code, payload, begin, places_);
}

void StreamDecoder::TakeCutPacket(std::span<const std::uint8_t> packet) {
  ByteReader reader(packet);
  const std::uint32_t tag = reader.Varint();
  if (!reader.ok() || static_cast<PacketType>(tag % kPacketTypes) != PacketType::kGroup) return;
  std::span<const std::uint8_t> payload = packet.subspan(reader.position());
  payload = payload.first(std::min<std::size_t>(payload.size(), tag / kPacketTypes));  // the check may have begun
  GroupSyntax group;
  std::span<const std::uint8_t> code;
  if (!ParseGroup(payload, group, code).ok() || group.open() || group.layered()) return;
  if (start_.CheckSegment(group.segment).ok() && PrepareGroups().ok())
    groups_->TakeCutGroup(group, code, total_frames_);
}

Status StreamDecoder::PrepareGroups() {
  if (groups_ && start_.IsReady()) return Status::Ok();
  if (groups_) position_ = groups_->position();
  groups_.reset();
  handles_.reset();
  SAC_RETURN_IF_ERROR(start_.Prepare());
  groups_.emplace(*start_.header(), start_.shape(), settings_, damage_, position_);
  return Status::Ok();
}

Status StreamDecoder::Prepare() {
  if (error_) return *error_;
  if (!start_.mesh()) return Status::NeedMoreData();
  if (start_.MeshEnds() && groups_) return Status::Ok();
  return Latch(PrepareGroups());
}

Status StreamDecoder::Flush() {
  if (error_) return *error_;
  return groups_ && groups_->WaitsForLayers() ? Latch(groups_->DoWithoutLayers()) : Status::Ok();
}

Status StreamDecoder::TakeEnd(std::span<const std::uint8_t> payload, std::uint64_t begin) {
  if (!start_.mesh()) return damage_.Judge(Status::Corrupt("the end before the I-frame"));
  if (!groups_) SAC_RETURN_IF_ERROR(PrepareGroups());  // a start that cannot be decoded makes no stream
  std::uint32_t frames = 0;
  if (Status status = ParseAndCheckEnd(payload, begin, frames); !status.ok()) return damage_.Judge(std::move(status));
  total_frames_ = frames;
  ended_ = true;
  return Status::Ok();
}

Status StreamDecoder::ParseAndCheckEnd(std::span<const std::uint8_t> payload, std::uint64_t begin,
                                       std::uint32_t& frames) {
  EndSyntax end;
  SAC_RETURN_IF_ERROR(ParseEnd(payload, settings_.limits, end));
  SAC_RETURN_IF_ERROR(groups_->CheckEnd(end.frames));
  if (end.index && packets_.from_start() && !lost().any() && !places_.Matches(*end.index, begin)) {
    return Status::Corrupt("end: the index is not the stream's");
  }
  frames = end.frames;
  return Status::Ok();
}

bool StreamDecoder::CanAdvance() {
  if (held_packet_) return true;
  if (ended_) return false;
  if (!finished_ || packets_.HasOld()) return packets_.HasOld();
  std::vector<std::uint8_t> cut;
  if (packets_.Finish(cut)) return true;
  if (groups_ && groups_->WaitsForLayers()) return true;
  if (start_.mesh() && !(groups_ && groups_->GroupIsOpen())) TakeCutPacket(cut);
  return FrameWaits();
}

Status StreamDecoder::AdvanceAlone() {
  if (FrameWaits()) return Status::Ok();
  if (finished_ && groups_ && groups_->WaitsForLayers() && !packets_.HasOld()) return Flush();
  std::span<const std::uint8_t> none;
  return Latch(Advance(none));
}

template <class CheckOutput>
Status StreamDecoder::Next(const CheckOutput& check, FrameOutput& output, std::uint32_t& frame) {
  while (true) {
    if (error_) return *error_;
    SAC_RETURN_IF_ERROR(check());  // in each round, since the mesh may be among the bytes that are read again
    if (!FrameWaits()) {
      if (!CanAdvance()) return Status::NeedMoreData();
      SAC_RETURN_IF_ERROR(AdvanceAlone());
      continue;
    }
    std::optional<std::uint32_t> shown;
    SAC_RETURN_IF_ERROR(Latch(groups_->NextFrame(output, shown)));
    if (!shown) continue;
    frame = *shown;
    return Status::Ok();
  }
}

Status StreamDecoder::Receive(Positions& positions, FrameInfo& info, const FrameBuffers* buffers) {
  FrameOutput output{&positions};
  std::uint32_t frame = 0;
  SAC_RETURN_IF_ERROR(Next([&] { return Check(buffers); }, output, frame));
  GiveOut(frame, frame, positions, info, buffers);
  return Status::Ok();
}

Status StreamDecoder::ReceiveHandles(std::span<float> matrices, FrameInfo& info, bool& exact) {
  FrameOutput output;
  std::uint32_t frame = 0;
  SAC_RETURN_IF_ERROR(Next([&] { return CheckHandles(matrices); }, output, frame));
  Describe(frame, frame, info);
  info.box = handles_->Fill(*output.blend, matrices);
  exact = output.exact;
  return Status::Ok();
}

Status StreamDecoder::CheckHandles(std::span<float> matrices) {
  if (!groups_) return Status::Ok();  // no frame waits
  if (start_.header()->references_previous()) {
    return Status::Unsupported("frames measured against the frame before are no blend of handles");
  }
  const Shape& shape = start_.shape();
  if (!handles_) handles_.emplace(shape);
  if (matrices.size() == 12 * handles_->handles()) return Status::Ok();
  return Status::InvalidArgument("matrices of " + std::to_string(matrices.size()) + " floats, " +
                                 std::to_string(handles_->handles()) + " handles have 12 each");
}

Status StreamDecoder::Weights(BlendWeights& weights) {
  if (error_) return *error_;
  if (!start_.mesh()) return Status::NeedMoreData();
  if (!groups_) SAC_RETURN_IF_ERROR(Latch(PrepareGroups()));
  Status status = CheckHandles({});
  if (!handles_) return status;
  weights = handles_->Weights();
  return Status::Ok();
}

void StreamDecoder::Describe(std::uint32_t frame, double time, FrameInfo& info) const {
  const SequenceHeader& header = *start_.header();
  info.index = frame;
  info.intra = groups_->IsIntra(frame);
  info.segment = start_.segment().value_or(0);
  info.time = header.frame_rate_numerator == 0 ? 0 : time / header.frames_per_second();
}

void StreamDecoder::GiveOut(std::uint32_t frame, double time, const Positions& positions, FrameInfo& info,
                            const FrameBuffers* buffers) {
  Describe(frame, time, info);
  info.box = BoundingBox(positions);
  if (buffers) FillBuffers(positions, start_.mesh()->triangles, info.box, *buffers, normals_);
}

Status StreamDecoder::Finish() {
  if (error_) return *error_;
  const auto truncated = [this] { return Truncated(packets_.position(), groups_ ? groups_->next_frame() : 0); };
  if (!damage_.skips()) return ended_ && !FrameWaits() ? Status::Ok() : Latch(truncated());
  finished_ = true;
  while (!FrameWaits() && CanAdvance()) SAC_RETURN_IF_ERROR(AdvanceAlone());
  return ended_ || (FrameWaits() && packets_.HasMore()) ? Status::Ok() : truncated();
}

}  // namespace sac

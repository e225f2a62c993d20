// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/stream_decoder.h"

#include <algorithm>
#include <utility>

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
  std::optional<Packet> packet;
  bool damaged = false;
  SAC_RETURN_IF_ERROR(packets_.Read(bytes, packet, damaged));
  if (damaged && groups_) groups_->CloseGroup();
  if (!packet) return Status::Ok();
  const std::uint64_t size = PacketSize(packet->payload.size());
  return Take(*packet, packets_.position() - std::min(size, packets_.position()));
}

Status StreamDecoder::Take(const Packet& packet, std::uint64_t begin) {
  SAC_RETURN_IF_ERROR(start_.CheckOrder(packet.type));
  switch (packet.type) {
    case PacketType::kHeader:
      return start_.TakeHeader(packet.payload);
    case PacketType::kIFrame:
      return TakeIFrame(packet.payload);
    case PacketType::kGroup:
      return TakeGroup(packet.payload, begin);
    case PacketType::kFrame:
      return groups_ ? groups_->TakeFrame(packet.payload) : Status::Ok();
    case PacketType::kGroupEnd:
      if (groups_) groups_->CloseGroup();
      return Status::Ok();
    case PacketType::kEnd:
      return TakeEnd(packet.payload, begin);
  }
  return Status::Corrupt("unknown packet");
}

Status StreamDecoder::TakeIFrame(std::span<const std::uint8_t> payload) {
  bool is_new = false;
  SAC_RETURN_IF_ERROR(start_.TakeIFrame(payload, is_new));
  if (!is_new) return Status::Ok();
  groups_.emplace(*start_.header(), start_.shape(), settings_, damage_, 0);
  places_.Start(packets_.position(), packets_.from_start());
  return Status::Ok();
}

Status StreamDecoder::TakeGroup(std::span<const std::uint8_t> payload, std::uint64_t begin) {
  if (!groups_) return damage_.Judge(Status::Corrupt("a group before the I-frame"));
  return start_.is_foreign() ? Status::Ok() : groups_->TakeGroup(payload, begin, places_);
}

Status StreamDecoder::TakeEnd(std::span<const std::uint8_t> payload, std::uint64_t begin) {
  if (!groups_) return damage_.Judge(Status::Corrupt("the end before the I-frame"));
  if (start_.is_foreign()) return Status::Ok();
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
  if (ended_) return false;
  if (!finished_ || packets_.HasOld()) return packets_.HasOld();
  std::vector<std::uint8_t> cut;
  if (packets_.Finish(cut)) return true;
  if (groups_ && !groups_->GroupIsOpen() && !start_.is_foreign()) groups_->TakeCutPacket(cut, total_frames_);
  return FrameWaits();
}

Status StreamDecoder::AdvanceAlone() {
  std::span<const std::uint8_t> none;
  return FrameWaits() ? Status::Ok() : Latch(Advance(none));
}

Status StreamDecoder::Receive(Positions& positions, FrameInfo& info, const FrameBuffers* buffers) {
  while (true) {
    if (error_) return *error_;
    SAC_RETURN_IF_ERROR(
        Check(buffers));  // checked in each round, since the mesh may be among the bytes that are read again
    if (!FrameWaits()) {
      if (!CanAdvance()) return Status::NeedMoreData();
      SAC_RETURN_IF_ERROR(AdvanceAlone());
      continue;
    }
    std::optional<std::uint32_t> frame;
    SAC_RETURN_IF_ERROR(Latch(groups_->NextFrame(positions, frame)));
    if (!frame) continue;
    GiveOut(*frame, *frame, positions, info, buffers);
    return Status::Ok();
  }
}

void StreamDecoder::GiveOut(std::uint32_t frame, double time, const Positions& positions, FrameInfo& info,
                            const FrameBuffers* buffers) {
  const SequenceHeader& header = *start_.header();
  info.index = frame;
  info.intra = groups_->IsIntra(frame);
  info.time = header.frame_rate_numerator == 0 ? 0 : time / header.frames_per_second();
  info.box = BoundingBox(positions);
  if (buffers) FillBuffers(positions, start_.shape().triangles, info.box, *buffers, normals_);
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

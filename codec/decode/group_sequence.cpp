// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/group_sequence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "format/bytes.h"
#include "format/crc32.h"
#include "format/group_syntax.h"
#include "format/packet.h"

namespace sac {
namespace {

unsigned ThreadsFor(const SequenceHeader& header, const DecoderSettings& settings, Shape& shape) {
  // Frames that are measured against the frame before cannot be reconstructed beside each other.
  return UseThreads(header.references_previous() ? 1 : std::max(1u, settings.threads), settings.limits, shape);
}

std::uint32_t FrameBefore(double time) { return static_cast<std::uint32_t>(time); }
std::uint32_t FrameAfter(double time) { return static_cast<std::uint32_t>(std::ceil(time)); }

}  // namespace

GroupSequence::GroupSequence(const SequenceHeader& header, Shape& shape, const DecoderSettings& settings,
                             DamagePolicy& damage, std::uint64_t first_frame)
    : header_(header),
      settings_(settings),
      damage_(damage),
      source_(shape, header, ThreadsFor(header, settings, shape), settings.run_jobs),
      parser_(header, shape, settings.limits),
      next_frame_(first_frame) {}

Status GroupSequence::ContinueAt(std::uint32_t frame) {
  const std::uint64_t expected = next_frame_.value_or(frame);
  if (frame < expected && damage_.skips()) return Status::Corrupt("frames that were there before");
  next_frame_ = frame;
  if (frame == expected) return Status::Ok();
  return damage_.Judge(
      Status::Corrupt("frame " + std::to_string(frame) + " where frame " + std::to_string(expected) + " is expected"),
      expected, frame);
}

Status GroupSequence::TakeGroup(std::span<const std::uint8_t> payload, std::uint64_t begin, SeekTable& places) {
  GroupSyntax group;
  std::span<const std::uint8_t> code;
  Status status = ParseGroup(payload, group, code);
  if (status.ok()) status = ContinueAt(group.first_frame);
  if (!status.ok()) return damage_.Judge(std::move(status));
  places.Add(begin, group.first_frame);
  if (group.open()) {
    parser_.Open(group.first_frame);
    group_begins_ = true;
    return Status::Ok();
  }
  const std::uint64_t end = std::uint64_t{group.first_frame} + group.frames;
  next_frame_ = end;
  if (end <= wanted_) return Status::Ok();
  return damage_.Judge(ReadGroup(group, code, {begin, payload.size(), Crc32(payload)}), group.first_frame, end);
}

Status GroupSequence::ReadGroup(const GroupSyntax& group, std::span<const std::uint8_t> code, const HeldGroup& sent) {
  if (held_ == sent) {  // a seek went back to the group that is held
    SAC_RETURN_IF_ERROR(source_.Restart());
  } else {
    held_.reset();
    CodedFrames frames;
    SAC_RETURN_IF_ERROR(parser_.Parse(group, code, false, frames));
    SAC_RETURN_IF_ERROR(source_.Take(std::move(frames), true));
    held_ = sent;
  }
  next_out_ = group.first_frame;
  return Status::Ok();
}

Status GroupSequence::TakeFrame(std::span<const std::uint8_t> payload) {
  if (!parser_.is_open()) return Status::Ok();  // a record of a group that has been given up
  CodedFrames frames;
  Status status = parser_.ParseNext(payload, frames);
  if (status.ok()) {
    next_out_ = frames.first;
    next_frame_ = frames.end();
    held_.reset();
    status = source_.Take(std::move(frames), std::exchange(group_begins_, false));
  }
  if (status.ok()) return status;
  status = damage_.Judge(std::move(status));
  if (status.ok()) parser_.Close();  // frames after this one cannot be decoded
  return status;
}

void GroupSequence::TakeCutPacket(std::span<const std::uint8_t> packet, std::optional<std::uint32_t> total_frames) {
  ByteReader reader(packet);
  const std::uint32_t tag = reader.Varint();
  if (!reader.ok() || static_cast<PacketType>(tag & 3) != PacketType::kGroup) return;
  auto payload = packet.subspan(reader.position());
  payload = payload.first(std::min<std::size_t>(payload.size(), tag / 4));  // the check may have begun
  GroupSyntax group;
  std::span<const std::uint8_t> code;
  if (!ParseGroup(payload, group, code).ok() || group.open()) return;
  // The packet's CRC-32 is missing, so its numbers are trusted only when they fit.
  const std::uint64_t end = std::uint64_t{group.first_frame} + group.frames;
  if (next_frame_.value_or(group.first_frame) != group.first_frame) return;
  if (end > total_frames.value_or(0xffffffffu)) return;
  next_frame_ = end;
  CodedFrames frames;
  if (!parser_.Parse(group, code, true, frames).ok()) return damage_.Lose(group.first_frame, end);
  while (!frames.frames.back().whole) frames.frames.pop_back();
  held_.reset();
  damage_.Lose(frames.end(), end);
  if (source_.Take(std::move(frames), true).ok()) next_out_ = group.first_frame;
}

Status GroupSequence::CheckEnd(std::uint32_t frames) {
  if (!next_frame_ || *next_frame_ == frames) return Status::Ok();
  Status status = Status::Corrupt("end: " + std::to_string(frames) + " frames declared, " +
                                  std::to_string(*next_frame_) + " found");
  // When more frames have come than are declared, the declaration is wrong and no frame is lost.
  return frames > *next_frame_ ? damage_.Judge(std::move(status), *next_frame_, frames) : status;
}

Status GroupSequence::NextFrame(Positions& positions, std::optional<std::uint32_t>& shown) {
  shown.reset();
  const auto frame = static_cast<std::uint32_t>(next_out_++);
  const bool is_shown = frame >= wanted_ && frame % settings_.frame_step == 0;
  if (!is_shown && !header_.references_previous()) return Status::Ok();
  Status status = source_.Reconstruct(frame, settings_.frame_step, positions);
  if (!status.ok()) return damage_.Judge(std::move(status), frame, std::uint64_t{frame} + 1);
  if (is_shown) shown = frame;
  return Status::Ok();
}

bool GroupSequence::HoldsAround(double time) const {
  return source_.Holds(FrameBefore(time)) && source_.Holds(FrameAfter(time));
}

Status GroupSequence::CanCome(double time) const {
  const std::uint32_t frame = FrameBefore(time), after = FrameAfter(time);
  if (!next_frame_ || after >= *next_frame_) return Status::Ok();
  const std::string frames = "frame " + std::to_string(frame) + " or the next is ";
  const LostFrames& lost = damage_.lost();
  if (lost.Has(frame) || lost.Has(after)) return Status::Corrupt(frames + "lost");
  return Status::InvalidArgument(frames + "gone");
}

Status GroupSequence::Interpolate(double time, Positions& positions) {
  wanted_ = std::max<std::uint64_t>(wanted_, FrameAfter(time));
  return source_.Interpolate(time, positions);
}

void GroupSequence::Seek(std::optional<std::uint32_t> first_frame, std::uint32_t wanted) {
  parser_.Close();
  next_frame_ = first_frame;
  if (!held_) source_.Drop();  // frames of an open or cut group cannot be recognized when they are sent again
  PassOverFrames();
  wanted_ = wanted;
}

}  // namespace sac

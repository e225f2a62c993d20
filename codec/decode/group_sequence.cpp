// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/group_sequence.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "format/crc32.h"
#include "format/group.h"

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
                             DamagePolicy& damage, const Position& position)
    : header_(header),
      settings_(settings),
      damage_(damage),
      source_(shape, header, ThreadsFor(header, settings, shape), settings.run_jobs),
      parser_(header, shape, settings.limits),
      next_frame_(position.next_frame),
      wanted_(position.wanted),
      layers_(position.layers) {}

Status GroupSequence::ContinueAt(std::uint32_t frame) {
  const std::uint64_t expected = next_frame_.value_or(frame);
  if (frame < expected && damage_.skips()) return Status::Corrupt("frames that were there before");
  next_frame_ = frame;
  if (frame == expected) return Status::Ok();
  return damage_.Judge(
      Status::Corrupt("frame " + std::to_string(frame) + " where frame " + std::to_string(expected) + " is expected"),
      expected, frame);
}

Status GroupSequence::TakeGroup(const GroupSyntax& group, std::span<const std::uint8_t> code,
                                std::span<const std::uint8_t> payload, std::uint64_t begin, SeekTable& places) {
  layered_.reset();
  if (group.layered()) {
    layered_.emplace().group = group;
    if (Status status = parser_.CountLayers(group, layered_->count); !status.ok()) {
      return damage_.Judge(std::move(status));
    }
  }
  layers_ = std::max(layers_, layered_ ? static_cast<std::uint32_t>(layered_->count) : 1);
  if (Status status = ContinueAt(group.first_frame); !status.ok()) return damage_.Judge(std::move(status));
  places.Add(begin, group.first_frame, group.segment);
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
    source_.Restart();
    next_out_ = group.first_frame;
    return Status::Ok();
  }
  held_.reset();
  if (group.layered()) return OpenLayers(code, sent);
  CodedFrames frames;
  SAC_RETURN_IF_ERROR(parser_.Parse(group, code, false, frames));
  source_.Take(std::move(frames), true);
  held_ = sent;
  next_out_ = group.first_frame;
  return Status::Ok();
}

Status GroupSequence::OpenLayers(std::span<const std::uint8_t> code, const HeldGroup& sent) {
  LayeredGroup& layered = *layered_;
  layered.sent = sent;
  layered.wanted = std::min<std::size_t>(layered.count, std::max(1u, settings_.layers));
  return KeepLayer(code);
}

Status GroupSequence::KeepLayer(std::span<const std::uint8_t> code) {
  LayeredGroup& layered = *layered_;
  layered.bytes += code.size();
  if (layered.bytes > settings_.limits.memory / 4) return Status::Limit("a group of layers larger than the limit");
  layered.codes.emplace_back(code.begin(), code.end());
  return layered.codes.size() == layered.wanted ? DoWithoutLayers() : Status::Ok();
}

Status GroupSequence::TakeLayer(std::span<const std::uint8_t> payload) {
  LayerSyntax layer;
  std::span<const std::uint8_t> code;
  if (Status status = ParseLayer(payload, layer, code); !status.ok()) return damage_.Judge(std::move(status));
  if (!layered_ || layered_->group.first_frame != layer.first_frame || layer.layer != layered_->next ||
      layer.layer >= layered_->count) {
    return damage_.Judge(Status::Corrupt("layer " + std::to_string(layer.layer) + " of the group of frame " +
                                         std::to_string(layer.first_frame) + ": out of place"));
  }
  ++layered_->next;
  return WaitsForLayers() ? KeepLayer(code) : Status::Ok();  // frames that are read go without the rest
}

Status GroupSequence::DoWithoutLayers() {
  LayeredGroup& layered = *layered_;
  const std::vector<std::vector<std::uint8_t>> codes = std::exchange(layered.codes, {});
  CodedFrames frames;
  const GroupSyntax& group = layered.group;
  if (Status status = parser_.ParseLayers(group, codes, frames); !status.ok()) {
    return damage_.Judge(std::move(status), group.first_frame, std::uint64_t{group.first_frame} + group.frames);
  }
  source_.Take(std::move(frames), true);
  if (codes.size() == layered.wanted) held_ = layered.sent;
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
    source_.Take(std::move(frames), std::exchange(group_begins_, false));
  }
  if (status.ok()) return status;
  status = damage_.Judge(std::move(status));
  if (status.ok()) parser_.Close();  // frames after this one cannot be decoded
  return status;
}

void GroupSequence::TakeCutGroup(const GroupSyntax& group, std::span<const std::uint8_t> code,
                                 std::optional<std::uint32_t> total_frames) {
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
  source_.Take(std::move(frames), true);
  next_out_ = group.first_frame;
}

Status GroupSequence::CheckEnd(std::uint32_t frames) {
  if (!next_frame_ || *next_frame_ == frames) return Status::Ok();
  Status status = Status::Corrupt("end: " + std::to_string(frames) + " frames declared, " +
                                  std::to_string(*next_frame_) + " found");
  // When more frames have come than are declared, the declaration is wrong and no frame is lost.
  return frames > *next_frame_ ? damage_.Judge(std::move(status), *next_frame_, frames) : status;
}

Status GroupSequence::NextFrame(FrameOutput& output, std::optional<std::uint32_t>& shown) {
  shown.reset();
  const auto frame = static_cast<std::uint32_t>(next_out_++);
  const bool is_shown = frame >= wanted_ && frame % settings_.frame_step == 0;
  if (!is_shown && !header_.references_previous()) return Status::Ok();
  Status status = source_.Reconstruct(frame, settings_.frame_step, output);
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

Status GroupSequence::Interpolate(double time, FrameOutput& output) {
  wanted_ = std::max<std::uint64_t>(wanted_, FrameAfter(time));
  return source_.Interpolate(time, output);
}

void GroupSequence::Seek(std::optional<std::uint32_t> first_frame, std::uint32_t wanted) {
  parser_.Close();
  layered_.reset();
  next_frame_ = first_frame;
  if (!held_) source_.Drop();  // frames of an open or cut group cannot be recognized when they are sent again
  PassOverFrames();
  wanted_ = wanted;
}

}  // namespace sac

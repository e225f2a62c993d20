// SPDX-License-Identifier: Apache-2.0
#include "format/stream_splicer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "format/metadata.h"
#include "format/stream_index.h"

namespace sac {
namespace {

Box Union(const Box& a, const Box& b) {
  Box box;
  for (std::size_t i = 0; i < 3; ++i) {
    box.low[i] = std::min(a.low[i], b.low[i]);
    box.high[i] = std::max(a.high[i], b.high[i]);
  }
  return box;
}

// The smallest box of floats around `box`.
Box InFloats(const Box& box) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto below = [](double x) {
    const auto f = static_cast<float>(x);
    return static_cast<double>(static_cast<double>(f) > x ? std::nextafter(f, -kInfinity) : f);
  };
  Box out;
  for (std::size_t i = 0; i < 3; ++i) {
    out.low[i] = below(box.low[i]);
    out.high[i] = -below(-box.high[i]);
  }
  return out;
}

// The metadata without what belongs to single streams.
std::vector<std::uint8_t> OfClip(Metadata metadata) {
  metadata.first_frame.reset();
  metadata.bounds.reset();
  metadata.group_bounds.clear();
  return WriteMetadata(metadata);
}

}  // namespace

void StreamSplicer::Begin(const FrameSpan& wanted) {
  in_ = {};
  in_.wanted = wanted;
  ++inputs_;
}

Status StreamSplicer::Take(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    if (in_.ended) return Status::Corrupt("bytes after the end of the stream");
    std::optional<Packet> packet;
    SAC_RETURN_IF_ERROR(in_.reader.Read(bytes, packet));
    if (packet) SAC_RETURN_IF_ERROR(TakePacket(std::move(*packet)));
  }
  return Status::Ok();
}

Status StreamSplicer::TakePacket(Packet packet) {
  switch (packet.type) {
    case PacketType::kHeader:
      SAC_RETURN_IF_ERROR(PutGroup());
      in_.start = {std::move(packet.payload), {}};
      return CheckHeader();
    case PacketType::kIFrame:
      if (in_.start.header.empty() || !in_.start.i_frame.empty()) {
        return Status::Corrupt("an I-frame without a header before it");
      }
      in_.start.i_frame = std::move(packet.payload);
      return Status::Ok();
    case PacketType::kGroup:
      return TakeGroup(packet);
    case PacketType::kLayer:
      return TakeLayer(packet);
    case PacketType::kFrame:
      in_.group->codes.push_back(std::move(packet.payload));
      ++in_.group->syntax.frames;
      return Status::Ok();
    case PacketType::kGroupEnd:
      return PutGroup();
    case PacketType::kEnd:
      return TakeEnd(packet);
    default:
      TakeSkippable(std::move(packet));
      return Status::Ok();
  }
}

Status StreamSplicer::CheckHeader() {
  SequenceHeader header;
  SAC_RETURN_IF_ERROR(ParseSequenceHeader(in_.start.header, Limits{}, header));
  if (!first_) first_ = header;
  const auto same = [&](auto member) { return header.*member == (*first_).*member; };
  if (!same(&SequenceHeader::frame_rate_numerator) || !same(&SequenceHeader::frame_rate_denominator)) {
    return Status::InvalidArgument("its frame rate is not that of the first stream");
  }
  if (!same(&SequenceHeader::offset_x) || !same(&SequenceHeader::offset_y) || !same(&SequenceHeader::offset_z)) {
    return Status::InvalidArgument("its offset is not that of the first stream");
  }
  return Status::Ok();
}

Status StreamSplicer::TakeGroup(const Packet& packet) {
  SAC_RETURN_IF_ERROR(PutGroup());
  if (in_.start.i_frame.empty()) return Status::Corrupt("a group before the I-frame");
  Group group;
  std::span<const std::uint8_t> code;
  SAC_RETURN_IF_ERROR(ParseGroup(packet.payload, group.syntax, code));
  if (group.syntax.first_frame != in_.frames) {
    return Status::Corrupt("a group begins with frame " + std::to_string(group.syntax.first_frame) + ", expected " +
                           std::to_string(in_.frames));
  }
  group.open = group.syntax.open();
  if (!group.open) group.codes.emplace_back(code.begin(), code.end());
  in_.group = std::move(group);
  return Status::Ok();
}

Status StreamSplicer::TakeLayer(const Packet& packet) {
  LayerSyntax layer;
  std::span<const std::uint8_t> code;
  SAC_RETURN_IF_ERROR(ParseLayer(packet.payload, layer, code));
  if (!in_.group || !in_.group->syntax.layered() || layer.first_frame != in_.group->syntax.first_frame ||
      layer.layer != in_.group->codes.size()) {
    return Status::Corrupt("a layer that does not follow its group");
  }
  in_.group->codes.emplace_back(code.begin(), code.end());
  return Status::Ok();
}

Status StreamSplicer::TakeEnd(const Packet& packet) {
  SAC_RETURN_IF_ERROR(PutGroup());
  EndSyntax end;
  SAC_RETURN_IF_ERROR(ParseEnd(packet.payload, Limits{}, end));
  if (end.frames != in_.frames) {
    return Status::Corrupt("the end says " + std::to_string(end.frames) + " frames, there are " +
                           std::to_string(in_.frames));
  }
  in_.ended = true;
  return Status::Ok();
}

void StreamSplicer::TakeSkippable(Packet packet) {
  if (packet.type == PacketType::kMetadata && ParseMetadata(packet.payload, in_.metadata).ok()) {
    Metadata alone;
    static_cast<void>(ParseMetadata(packet.payload, alone));
    if (inputs_ > 1 || alone.bounds) return;  // those of the clip are written once, boxes at the end
  }
  const std::uint64_t before = in_.frames + (in_.group ? in_.group->syntax.frames : 0);
  if (before == 0 || before < in_.wanted.end) in_.skippable.push_back(std::move(packet));
}

Status StreamSplicer::PutGroup() {
  if (!in_.group) return Status::Ok();
  const Group group = std::exchange(in_.group, std::nullopt).value();
  const std::size_t index = in_.groups++;
  const std::uint64_t first = in_.frames;
  in_.frames += group.syntax.frames;
  if (first >= in_.wanted.end || in_.frames <= in_.wanted.begin) return Status::Ok();
  if (in_.taken_groups.empty()) in_.taken = {first, first};
  SAC_RETURN_IF_ERROR(PutStart());
  if (std::uint64_t{writer_.frames()} + group.syntax.frames > 0xffffffffu) {
    return Status::Limit("more frames than a stream can have");
  }
  in_.taken_groups.push_back(index);
  in_.taken.end = in_.frames;
  *next_frame_ += group.syntax.frames;
  if (!group.open) {
    writer_.Group(group.syntax, group.codes, {});
    return Status::Ok();
  }
  writer_.OpenGroup();
  for (const std::vector<std::uint8_t>& code : group.codes) writer_.Frame(code, {});
  writer_.CloseGroup();
  return Status::Ok();
}

Status StreamSplicer::CheckOrder(std::int64_t number) const {
  if (settings_.renumber || number == *next_frame_) return Status::Ok();
  const std::string begins = "begins with frame " + std::to_string(number) + " of the clip, ";
  if (number > *next_frame_) {
    return Status::InvalidArgument(begins + "but frames from " + std::to_string(*next_frame_) + " on are missing");
  }
  return Status::InvalidArgument(begins + "but the streams before go to frame " + std::to_string(*next_frame_ - 1) +
                                 ": given twice, or in another order");
}

Status StreamSplicer::PutStart() {
  const bool is_first = writer_.groups() == 0, continues = !is_first && in_.start == start_;
  if (in_.taken_groups.empty()) {
    const std::int64_t number = in_.metadata.first_frame.value_or(0) + static_cast<std::int64_t>(in_.taken.begin);
    if (continues) SAC_RETURN_IF_ERROR(CheckOrder(number));
    next_frame_ = number;
    if (is_first && in_.taken.begin > 0) RenumberMetadata(number);
  }
  if (!continues) {
    start_ = in_.start;
    writer_.Start(start_.header, start_.i_frame);
  }
  PutSkippable();
  return Status::Ok();
}

void StreamSplicer::RenumberMetadata(std::int64_t number) {
  Metadata metadata = in_.metadata;
  metadata.bounds.reset();
  metadata.group_bounds.clear();
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  metadata.first_frame = static_cast<std::int32_t>(std::min(number, kMost));
  std::erase_if(in_.skippable, [](const Packet& packet) { return packet.type == PacketType::kMetadata; });
  in_.skippable.insert(in_.skippable.begin(), Packet{PacketType::kMetadata, WriteMetadata(metadata)});
}

void StreamSplicer::PutSkippable() {
  for (Packet& packet : std::exchange(in_.skippable, {})) {
    const auto same = [&](const Packet& other) { return other.type == packet.type && other.payload == packet.payload; };
    if (std::any_of(written_.begin(), written_.end(), same)) continue;
    writer_.Skippable(packet.type, packet.payload);
    written_.push_back(std::move(packet));
  }
}

void StreamSplicer::TakeBoxes() {
  const Metadata& said = in_.metadata;
  if (!said.bounds || in_.taken_groups.empty()) return;
  Box taken = *said.bounds;
  const bool of_groups = said.group_bounds.size() == in_.groups;
  if (of_groups && in_.taken_groups.size() < in_.groups) {
    taken = said.GroupBounds(in_.taken_groups.front());
    for (const std::size_t i : in_.taken_groups) taken = Union(taken, said.GroupBounds(i));
    taken = InFloats(taken);
  }
  for (const std::size_t i : in_.taken_groups) boxes_.push_back(of_groups ? said.GroupBounds(i) : taken);
  all_ = all_ ? Union(*all_, taken) : taken;
}

void StreamSplicer::PutBoxes() {
  if (!all_) return;
  if (boxes_.size() != writer_.groups()) {
    dropped_metadata_ = true;
    return;
  }
  Metadata metadata;
  metadata.bounds = all_;
  if (boxes_.size() > 1) {
    for (const Box& box : boxes_) metadata.group_bounds.push_back(InBounds(box, *all_));
  }
  writer_.Skippable(PacketType::kMetadata, WriteMetadata(metadata));
}

Status StreamSplicer::End() {
  if (!in_.ended) return Truncated(in_.reader.position(), in_.frames);
  if (!in_.taken_groups.empty()) PutSkippable();
  TakeBoxes();
  if (inputs_ == 1) metadata_ = in_.metadata;
  if (inputs_ > 1 && OfClip(in_.metadata) != OfClip(metadata_)) dropped_metadata_ = true;
  return Status::Ok();
}

Status StreamSplicer::Finish() {
  if (writer_.groups() == 0) {
    if (in_.start.i_frame.empty()) return Status::InvalidArgument("no stream has a mesh");
    writer_.Start(in_.start.header, in_.start.i_frame);
  }
  PutBoxes();
  writer_.End();
  return Status::Ok();
}

}  // namespace sac

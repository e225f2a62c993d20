// SPDX-License-Identifier: Apache-2.0
#include "format/stream_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "format/plane_layout.h"
#include "format/stream_index.h"

namespace sac {

void StreamWriter::Start(std::span<const std::uint8_t> header, std::span<const std::uint8_t> i_frame) {
  header_ = WritePacket(PacketType::kHeader, header);
  i_frame_ = WritePacket(PacketType::kIFrame, i_frame);
  if (segments_.empty()) Append(kMagic, &StreamBytes::header);
  if (!segments_.empty() && segments_.back().first_group == group_begins_.size()) segments_.pop_back();
  segments_.push_back({group_begins_.size(), written_});
  Append(header_, &StreamBytes::header);
  Append(i_frame_, &StreamBytes::i_frame);
}

void StreamWriter::Skippable(PacketType type, std::span<const std::uint8_t> payload) {
  Append(WritePacket(type, payload), &StreamBytes::header);
}

void StreamWriter::BeginGroup() {
  const std::size_t in_segment = group_begins_.size() - segments_.back().first_group;
  if (repeat_start_ != 0 && in_segment > 0 && in_segment % repeat_start_ == 0) {
    Append(header_, &StreamBytes::header);
    Append(i_frame_, &StreamBytes::i_frame);
  }
  group_begins_.push_back(written_);
  group_frames_.push_back(0);
}

void StreamWriter::Group(GroupSyntax group, std::span<const std::vector<std::uint8_t>> codes, const FrameBits& bits) {
  BeginGroup();
  const double before = sizes_.side;
  group.first_frame = frames_;
  group.segment = segment();
  Append(WritePacket(PacketType::kGroup, WriteGroup(group, codes[0])), &StreamBytes::side);
  for (std::uint32_t i = 1; i < codes.size(); ++i) {
    Append(WritePacket(PacketType::kLayer, WriteLayer({group.first_frame, i}, codes[i])), &StreamBytes::side);
  }
  Account(bits, before);
  group_frames_.back() = group.frames;
  frames_ += group.frames;
}

void StreamWriter::OpenGroup() {
  BeginGroup();
  Append(records_.Open(frames_, segment()), &StreamBytes::side);
}

void StreamWriter::Frame(std::span<const std::uint8_t> code, const FrameBits& bits) {
  const double before = sizes_.side;
  Append(records_.Frame(code), &StreamBytes::side);
  Account(bits, before);
  ++group_frames_.back();
  ++frames_;
}

void StreamWriter::CloseGroup() { Append(records_.End(), &StreamBytes::side); }

void StreamWriter::End() {
  EndSyntax end{frames_, std::nullopt};
  if (wants_index_ && group_begins_.size() > 1 && written_ - group_begins_.front() <= 0xffffffffu) {
    StreamIndex& index = end.index.emplace();
    index.first_group = static_cast<std::uint32_t>(group_begins_.front());
    for (std::size_t i = 1; i < segments_.size() && segments_[i].first_group < group_begins_.size(); ++i) {
      const std::size_t first = segments_[i].first_group;
      index.segments.push_back({static_cast<std::uint32_t>(first - segments_[i - 1].first_group),
                                static_cast<std::uint32_t>(group_begins_[first] - segments_[i].start)});
    }
    for (std::size_t i = 0; i < group_begins_.size(); ++i) {
      const std::uint64_t next = i + 1 < group_begins_.size() ? group_begins_[i + 1] : written_;
      index.groups.push_back({static_cast<std::uint32_t>(next - group_begins_[i]), group_frames_[i]});
    }
  }
  Append(WritePacket(PacketType::kEnd, WriteEnd(end)), &StreamBytes::header);
}

void StreamWriter::Append(std::span<const std::uint8_t> more, double StreamBytes::*part) {
  bytes_.insert(bytes_.end(), more.begin(), more.end());
  sizes_.*part += static_cast<double>(more.size());
  written_ += more.size();
}

void StreamWriter::Account(const FrameBits& bits, double side_before) {
  constexpr std::array<double StreamBytes::*, kPlanes> kParts = {&StreamBytes::motion, &StreamBytes::displacement,
                                                                 &StreamBytes::detail, &StreamBytes::correction};
  for (std::size_t p = 0; p < kPlanes; ++p) {
    const double plane = std::min(std::round(bits.planes[p] / 8), sizes_.side - side_before);
    sizes_.side -= plane;
    sizes_.*kParts[p] += plane;
  }
}

std::vector<std::uint8_t> StreamWriter::TakeBytes() { return std::exchange(bytes_, {}); }

}  // namespace sac

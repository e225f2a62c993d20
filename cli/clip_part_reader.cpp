// SPDX-License-Identifier: Apache-2.0
#include "cli/clip_part_reader.h"

#include <algorithm>
#include <span>

#include "files/stream_input.h"
#include "format/packet.h"
#include "format/sequence_header.h"

namespace sac {

std::optional<std::uint32_t> ClipPartReader::frame_count() const {
  std::optional<std::uint32_t> end = wanted_.end;
  if (const std::optional<std::uint32_t> all = clip_.frame_count()) end = std::min(end.value_or(*all), *all);
  if (end) *end -= std::min(*end, wanted_.begin);
  return end;
}

Status ClipPartReader::TooShort() const {
  return Status::InvalidArgument(clip_.name() + ": has " + std::to_string(next_) +
                                 " frames of this mesh, numbers from 0 on; " + std::to_string(wanted_.begin) + ":" +
                                 (wanted_.end ? std::to_string(*wanted_.end) : std::string()) + " is not within them");
}

Status ClipPartReader::Next(Positions& frame, bool& end) {
  for (; next_ < wanted_.begin; ++next_) {
    SAC_RETURN_IF_ERROR(clip_.Next(frame, end));
    if (end) return TooShort();
  }
  Positions behind;
  const bool is_end = wanted_.end && next_ >= *wanted_.end;
  SAC_RETURN_IF_ERROR(clip_.Next(is_end ? behind : frame, end));
  if (is_end) {
    clip_goes_on_ = !end;
    end = true;
    return Status::Ok();
  }
  if (end) return wanted_.end || next_ == wanted_.begin ? TooShort() : Status::Ok();
  ++next_;
  return Status::Ok();
}

Status ClipPartReader::Rewind() {
  next_ = 0;
  clip_goes_on_ = false;
  return clip_.Rewind();
}

Status ReadStartFile(const std::string& path, std::vector<std::uint8_t>& start, FrameRate& rate) {
  StreamInput input;
  SAC_RETURN_IF_ERROR(input.Open(path));
  start.clear();
  for (std::span<const std::uint8_t> chunk;;) {
    SAC_RETURN_IF_ERROR(input.Read(chunk));
    if (chunk.empty()) break;
    start.insert(start.end(), chunk.begin(), chunk.end());
  }
  // The rest is checked when it is used, which takes longer.
  const auto at = [&](const Status& s) { return Status(s.code(), input.name() + ": " + s.message()); };
  PacketReader reader{Limits{}};
  std::span<const std::uint8_t> rest = start;
  std::optional<Packet> packet;
  SequenceHeader header;
  if (const Status s = reader.Read(rest, packet); !s.ok()) return at(s);
  if (!packet || packet->type != PacketType::kHeader) return at(Status::Corrupt("not the start of a stream"));
  if (const Status s = ParseSequenceHeader(packet->payload, Limits{}, header); !s.ok()) return at(s);
  rate = {header.frame_rate_numerator, header.frame_rate_denominator};
  return Status::Ok();
}

}  // namespace sac

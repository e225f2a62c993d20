// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/packet_source.h"

#include <utility>

#include "format/group.h"

namespace sac {
namespace {

// Bytes that look like the beginning of a packet again and again are read again each time. The number of bytes that may
// be read again is kMaxRereading times the bytes so far plus kFreeRereading. Beyond that, each packet is found by a
// search, which reads each byte once.
constexpr std::uint64_t kMaxRereading = 4, kFreeRereading = 1 << 20;

}  // namespace

Status PacketSource::Read(std::span<const std::uint8_t>& bytes, std::optional<Packet>& packet, bool& damaged) {
  packet.reset();
  damaged = false;
  if (!HasOld()) return ReadFrom(bytes, packet, damaged);
  Status status;
  while (status.ok() && !packet && !damaged && HasOld()) {
    std::span<const std::uint8_t> rest = std::span(replay_).subspan(replayed_);
    status = ReadFrom(rest, packet, damaged);
  }
  if (!HasOld()) {
    replay_.clear();
    replayed_ = 0;
  }
  return status;
}

Status PacketSource::ReadFrom(std::span<const std::uint8_t>& bytes, std::optional<Packet>& packet, bool& damaged) {
  const bool replays = HasOld();
  const std::size_t before = bytes.size();
  Status status;
  if (search_) {
    search_->Read(bytes, packet);
  } else {
    status = reader_.Read(bytes, packet);
  }
  position_ += before - bytes.size();
  if (replays) replayed_ += before - bytes.size();
  if (!status.ok() && skip_damage_) {
    damaged = true;
    Resynchronize(reader_.TakePending());
    return Status::Ok();
  }
  if (packet && search_) {
    reader_.Restart(position_, packet->type == PacketType::kGroup && OpensGroup(packet->payload));
    search_.reset();
    if (reread_ > kMaxRereading * position_ + kFreeRereading) search_.emplace(limits_);
  }
  return status;
}

void PacketSource::Resynchronize(std::vector<std::uint8_t> pending) {
  search_.emplace(limits_);
  from_start_ = false;
  if (pending.empty()) return;
  const std::size_t back = pending.size() - 1;
  position_ -= back;
  reread_ += back;
  if (pending.size() <= replayed_) {
    replayed_ -= back;
  } else {  // `pending` contains all bytes that were being read again
    replay_ = std::move(pending);
    replayed_ = 1;
  }
}

bool PacketSource::Finish(std::vector<std::uint8_t>& cut) {
  cut.clear();
  if (HasOld()) return true;
  if (search_) return false;
  std::vector<std::uint8_t> pending = reader_.TakePending();
  if (pending.empty()) return false;
  PacketSearch search(limits_);
  std::optional<Packet> found;
  std::span<const std::uint8_t> rest = std::span(pending).subspan(1);
  search.Read(rest, found);
  if (found) {
    Resynchronize(std::move(pending));
  } else {
    cut = std::move(pending);
  }
  return HasOld();
}

void PacketSource::Restart(std::uint64_t position) {
  reader_.Restart(position, false);
  search_.reset();
  replay_.clear();
  replayed_ = 0;
  position_ = position;
  from_start_ = false;
}

}  // namespace sac

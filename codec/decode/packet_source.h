// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "format/packet.h"
#include "format/packet_search.h"
#include "sac/limits.h"
#include "sac/status.h"

namespace sac {

// The packets of a stream, and the records of open groups, out of bytes in any chunking. After damage it goes on, if it
// is to, with the next packet that is sound; for that it reads bytes again, from the damaged packet's second on.
class PacketSource {
 public:
  PacketSource(const Limits& limits, bool skip_damage) : limits_(limits), skip_damage_(skip_damage), reader_(limits) {}

  // The next packet, if one is complete: from the front of `bytes` or, as long as there are any, from bytes that are
  // read again; then `bytes` are left alone. `damaged` is set when packets have been skipped; without skip_damage
  // damage is an error, kCorrupt or kLimit.
  Status Read(std::span<const std::uint8_t>& bytes, std::optional<Packet>& packet, bool& damaged);
  // Whether there are bytes that have not become a packet, and may.
  bool HasMore() const { return HasOld() || (!search_ && !reader_.IsBetweenPackets()); }
  // Whether there are bytes to be read again.
  bool HasOld() const { return replayed_ < replay_.size(); }

  // No more bytes will come. Returns whether there is more to be read: other packets in one that is not complete, since
  // its size may be damaged. If there is none, `cut` are the bytes of the packet that is not complete.
  bool Finish(std::vector<std::uint8_t>& cut);

  // Goes on at byte `position` of the stream, where a packet begins.
  void Restart(std::uint64_t position);

  // In the stream, of the next byte to be read.
  std::uint64_t position() const { return position_; }
  // Whether everything has been read from the first byte on, without damage.
  bool from_start() const { return from_start_; }

 private:
  Status ReadFrom(std::span<const std::uint8_t>& bytes, std::optional<Packet>& packet, bool& damaged);
  void Resynchronize(std::vector<std::uint8_t> pending);

  Limits limits_;
  bool skip_damage_;
  PacketReader reader_;
  std::optional<PacketSearch> search_;  // instead of the reader
  std::vector<std::uint8_t> replay_;    // bytes to be read again, from replayed_ on
  std::size_t replayed_ = 0;
  std::uint64_t reread_ = 0;  // bytes that were, in all
  std::uint64_t position_ = 0;
  bool from_start_ = true;
};

}  // namespace sac

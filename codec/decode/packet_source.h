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

// Cuts the bytes of a stream, which may come in any chunking, into packets and records of open groups. With skip_damage
// it continues after damage with the next sound packet. To find that packet it reads the bytes of the damaged one
// again, from its second byte on.
class PacketSource {
 public:
  PacketSource(const Limits& limits, bool skip_damage) : limits_(limits), skip_damage_(skip_damage), reader_(limits) {}

  // Gives the next packet if one is complete. It is read from bytes to be read again while there are any, and then
  // `bytes` stays as it is; otherwise from the front of `bytes`. `damaged` is set when packets have been skipped.
  // Without skip_damage, damage is an error instead: kCorrupt or kLimit.
  Status Read(std::span<const std::uint8_t>& bytes, std::optional<Packet>& packet, bool& damaged);
  // Whether there are bytes that are not part of a packet yet and may become one.
  bool HasMore() const { return HasOld() || (!search_ && !reader_.IsBetweenPackets()); }
  // Whether there are bytes to be read again.
  bool HasOld() const { return replayed_ < replay_.size(); }

  // Declares the end of the bytes. Returns whether there is more to read: the size of an incomplete packet may be
  // damaged and other packets may lie in its bytes. If there is nothing more, `cut` gets the bytes of the incomplete
  // packet.
  bool Finish(std::vector<std::uint8_t>& cut);

  // Goes on at byte `position` of the stream, where a packet begins.
  void Restart(std::uint64_t position);

  // The position in the stream, in bytes, of the next byte to be read.
  std::uint64_t position() const { return position_; }
  // Whether everything has been read from the first byte on, without damage.
  bool from_start() const { return from_start_; }

 private:
  Status ReadFrom(std::span<const std::uint8_t>& bytes, std::optional<Packet>& packet, bool& damaged);
  void Resynchronize(std::vector<std::uint8_t> pending);

  Limits limits_;
  bool skip_damage_;
  PacketReader reader_;
  std::optional<PacketSearch> search_;  // after damage, used instead of reader_
  std::vector<std::uint8_t> replay_;    // bytes to be read again, from replayed_ on
  std::size_t replayed_ = 0;
  std::uint64_t reread_ = 0;  // number of bytes that were read again so far
  std::uint64_t position_ = 0;
  bool from_start_ = true;
};

}  // namespace sac

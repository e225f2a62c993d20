// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/packet.h"
#include "sac/limits.h"
#include "sac/status.h"

namespace sac {

// Copies a stream without the last layers of its groups (spec.md 6.1), and writes its index anew. Nothing is decoded,
// and all other bytes stay as they are.
class StreamThinner {
 public:
  // Keeps `layers` layers of each group, at least one.
  explicit StreamThinner(std::uint32_t layers) : layers_(layers), reader_(Limits{}) {}

  // Takes bytes of the stream, which may come in any chunking, and appends to `out` what is kept of them. Returns
  // kCorrupt, kUnsupported or kLimit when the stream's packets are at fault.
  Status Take(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& out);
  // Declares the end of the stream. Returns kCorrupt when it is not complete.
  Status Finish() const;

  std::uint64_t layers_dropped() const { return layers_dropped_; }

 private:
  // Appends the bytes `raw` of `packet`, or what becomes of them.
  Status Put(const Packet& packet, std::span<const std::uint8_t> raw, std::vector<std::uint8_t>& out);

  std::uint32_t layers_;
  PacketReader reader_;
  std::vector<std::uint8_t> raw_;             // bytes of the packet that has begun
  std::vector<std::uint32_t> dropped_bytes_;  // of each group
  std::uint64_t layers_dropped_ = 0;
  bool ended_ = false;
};

}  // namespace sac

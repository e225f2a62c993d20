// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <span>
#include <vector>

#include "format/packet.h"
#include "tests/join_packets.h"

namespace sac {

inline std::vector<Packet> Packets(const Bytes& stream) {
  std::vector<Packet> packets;
  PacketReader reader{Limits{}};
  std::optional<Packet> packet;
  for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
    EXPECT_TRUE(reader.Read(rest, packet).ok());
    if (packet) packets.push_back(*packet);
  }
  return packets;
}

}  // namespace sac

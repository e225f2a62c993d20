// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

#include "format/bytes.h"
#include "format/group.h"
#include "format/packet.h"

namespace sac {

using Bytes = std::vector<std::uint8_t>;

inline Bytes Concatenated(const std::vector<Bytes>& parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// The stream of `packets`, all checks right; open groups may be anywhere.
inline Bytes Join(const std::vector<Packet>& packets) {
  std::vector<Bytes> parts{Bytes(std::begin(kMagic), std::end(kMagic))};
  RecordWriter records;
  for (const Packet& p : packets) {
    const bool opens = p.type == PacketType::kGroup && OpensGroup(p.payload);
    parts.push_back(opens                          ? records.Open(ByteReader(std::span(p.payload).subspan(1)).Varint())
                    : p.type == PacketType::kFrame ? records.Frame(p.payload)
                    : p.type == PacketType::kGroupEnd ? records.End()
                                                      : WritePacket(p.type, p.payload));
  }
  return Concatenated(parts);
}

}  // namespace sac

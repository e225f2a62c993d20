// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/stream_mutation.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "format/bytes.h"
#include "format/group.h"
#include "format/sequence_header.h"
#include "tests/fuzz/stream_synthesis.h"

namespace sac {
namespace {

// The I-frame's parts can only be mutated by themselves: the mesh stands behind its size.
struct IFrameParts {
  Bytes mesh, code;
};

Bytes ToBytes(std::span<const std::uint8_t> span) { return {span.begin(), span.end()}; }

IFrameParts CutIFrame(const Bytes& payload) {
  IFrameParts parts;
  ByteReader reader(payload);
  parts.mesh = ToBytes(reader.Bytes(std::min<std::size_t>(reader.Varint(), reader.remaining())));
  parts.code = ToBytes(std::span(payload).subspan(reader.position()));
  return parts;
}

Bytes JoinIFrame(const IFrameParts& parts) {
  ByteWriter out;
  out.Varint(static_cast<std::uint32_t>(parts.mesh.size()));
  out.Bytes(parts.mesh);
  out.Bytes(parts.code);
  return std::move(out.bytes());
}

void MutateIFrame(Bytes& payload, std::mt19937& random, const MutateBytes& mutate) {
  IFrameParts parts = CutIFrame(payload);
  mutate(random() % 3 == 0 ? parts.mesh : parts.code, random);
  payload = JoinIFrame(parts);
}

void MutateOrder(std::vector<Packet>& packets, std::mt19937& random) {
  const std::size_t i = random() % packets.size(), j = random() % packets.size();
  const auto at = [&](std::size_t k) { return packets.begin() + static_cast<std::ptrdiff_t>(k); };
  switch (random() % 4) {
    case 0:
      std::swap(packets[i], packets[j]);
      break;
    case 1: {
      const Packet copy = packets[i];
      packets.insert(at(j), copy);
      break;
    }
    case 2:
      packets.erase(at(i));
      break;
    default:  // records are no packets, and the other way round
      packets[i].type = static_cast<PacketType>(random() % (kPacketTypes + 2));
  }
}

}  // namespace

std::vector<Packet> CutPackets(std::span<const std::uint8_t> stream) {
  std::vector<Packet> packets;
  ByteReader reader(stream);
  reader.Bytes(std::min<std::size_t>(sizeof kMagic, stream.size()));
  bool open = false;
  while (reader.remaining() > 0) {
    const std::uint32_t tag = reader.Varint();
    if (!reader.ok()) break;
    Packet packet;
    packet.type = !open      ? static_cast<PacketType>(tag % kPacketTypes)
                  : tag == 0 ? PacketType::kGroupEnd
                             : PacketType::kFrame;
    const std::uint32_t size = !open ? tag / kPacketTypes : tag == 0 ? 0 : tag - 1;
    packet.payload = ToBytes(reader.Bytes(std::min<std::size_t>(size, reader.remaining())));
    reader.Bytes(std::min<std::size_t>(packet.type == PacketType::kFrame ? 1 : 4, reader.remaining()));
    open = open ? tag != 0 : packet.type == PacketType::kGroup && OpensGroup(packet.payload);
    packets.push_back(std::move(packet));
  }
  return packets;
}

Bytes Repaired(std::span<const std::uint8_t> stream) {
  std::vector<Packet> packets = CutPackets(stream);
  for (Packet& packet : packets) {
    if (packet.type != PacketType::kHeader || packet.payload.size() < 2) continue;
    packet.payload[0] = kVersionMajor;
    packet.payload[1] = kVersionMinor;
  }
  return Join(packets);
}

void MutateAtRandom(Bytes& bytes, std::mt19937& random) {
  for (std::size_t i = 1 + random() % 3; i > 0; --i) {
    const std::size_t at = bytes.empty() ? 0 : random() % bytes.size();
    const auto position = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (bytes.empty() ? 5 : random() % 6) {
      case 0:
      case 1:
        bytes[at] ^= static_cast<std::uint8_t>(1 << (random() % 8));
        break;
      case 2:
        bytes[at] = static_cast<std::uint8_t>(random());
        break;
      case 3:
        bytes[at] = random() % 2 ? 0 : 0xff;
        break;
      case 4:
        bytes.erase(position);
        break;
      default:
        bytes.insert(position, static_cast<std::uint8_t>(random()));
    }
  }
}

Bytes MutateStream(std::span<const std::uint8_t> stream, std::mt19937& random, const MutateBytes& mutate) {
  std::vector<Packet> packets = CutPackets(stream);
  if (packets.empty()) {
    packets.push_back({PacketType::kHeader, {}});
    packets.push_back({PacketType::kIFrame, {}});
  }
  const std::uint32_t way = random() % 8;
  if (way < 2 && Resynthesize(packets, random)) return Join(packets);
  if (way == 2) {
    MutateOrder(packets, random);
  } else {
    Packet& packet = packets[random() % packets.size()];
    if (packet.type == PacketType::kIFrame) {
      MutateIFrame(packet.payload, random, mutate);
    } else {
      mutate(packet.payload, random);
    }
  }
  return Join(packets);
}

}  // namespace sac

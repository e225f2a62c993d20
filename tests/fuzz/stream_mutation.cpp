// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/stream_mutation.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "format/bytes.h"
#include "format/group_syntax.h"
#include "format/sequence_header.h"
#include "tests/fuzz/stream_synthesis.h"

namespace sac {
namespace {

// The I-frame's parts can only be mutated by themselves: between them stand their sizes.
struct IFrameParts {
  Bytes mesh, positions, side;
  std::uint32_t position_step = 16, position_slope = 0;
};

Bytes ToBytes(std::span<const std::uint8_t> span) { return {span.begin(), span.end()}; }

IFrameParts CutIFrame(const Bytes& payload) {
  IFrameParts parts;
  ByteReader reader(payload);
  const auto take = [&] { return ToBytes(reader.Bytes(std::min<std::size_t>(reader.Varint(), reader.remaining()))); };
  parts.mesh = take();
  if (!parts.mesh.empty()) {
    parts.position_step = reader.Varint();
    parts.position_slope = reader.Varint();
    parts.positions = take();
  }
  parts.side = ToBytes(std::span(payload).subspan(reader.position()));
  return parts;
}

Bytes JoinIFrame(const IFrameParts& parts) {
  ByteWriter out;
  out.Varint(static_cast<std::uint32_t>(parts.mesh.size()));
  out.Bytes(parts.mesh);
  if (!parts.mesh.empty()) {
    out.Varint(parts.position_step);
    out.Varint(parts.position_slope);
    out.Varint(static_cast<std::uint32_t>(parts.positions.size()));
    out.Bytes(parts.positions);
  }
  out.Bytes(parts.side);
  return std::move(out.bytes());
}

void MutateIFrame(Bytes& payload, std::mt19937& random, const MutateBytes& mutate) {
  IFrameParts parts = CutIFrame(payload);
  switch (random() % 4) {
    case 0:
      mutate(parts.mesh, random);
      break;
    case 1:
      mutate(parts.positions, random);
      break;
    case 2:
      mutate(parts.side, random);
      break;
    default:
      (random() % 2 ? parts.position_step : parts.position_slope) =
          static_cast<std::uint32_t>(random() >> random() % 32);
  }
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
      packets[i].type = static_cast<PacketType>(random() % 6);
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
    packet.type = !open ? static_cast<PacketType>(tag & 3) : tag == 0 ? PacketType::kGroupEnd : PacketType::kFrame;
    const std::uint32_t size = !open ? tag / 4 : tag == 0 ? 0 : tag - 1;
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

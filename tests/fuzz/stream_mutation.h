// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "format/packet.h"
#include "tests/join_packets.h"

namespace sac {

// The packets and records of a stream, however malformed: sizes are cut to the bytes there are, checks are not looked
// at. Joined again, they are a stream whose checks are right.
std::vector<Packet> CutPackets(std::span<const std::uint8_t> stream);

// The stream with every check right and the version that this decoder reads.
Bytes Repaired(std::span<const std::uint8_t> stream);

// Changes bytes, adds or takes some.
using MutateBytes = std::function<void(Bytes&, std::mt19937&)>;
void MutateAtRandom(Bytes& bytes, std::mt19937& random);

// Changes payloads, the parts of an I-frame, or the order and number of packets; checks are right in the end. Now and
// then writes the I-frame anew from changed syntax, with the fingerprint of its own basis, and groups that fit it: what
// mutations of bytes do not get to.
Bytes MutateStream(std::span<const std::uint8_t> stream, std::mt19937& random,
                   const MutateBytes& mutate = MutateAtRandom);

}  // namespace sac

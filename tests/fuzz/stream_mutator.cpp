// SPDX-License-Identifier: Apache-2.0
// libFuzzer's mutations, but behind the checks of packets and the fingerprint of the basis.
#include <algorithm>
#include <cstring>
#include <vector>

#include "tests/fuzz/stream_mutation.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

std::size_t Give(const sac::Bytes& stream, std::uint8_t* data, std::size_t max_size) {
  if (stream.size() > max_size || stream.empty()) return 0;
  std::memcpy(data, stream.data(), stream.size());
  return stream.size();
}

void MutateByLibFuzzer(sac::Bytes& bytes, std::mt19937&) {
  const std::size_t size = bytes.size();
  bytes.resize(size + 64);
  bytes.resize(LLVMFuzzerMutate(bytes.data(), size, bytes.size()));
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  std::mt19937 random(seed);
  if (random() % 64 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const std::size_t made = Give(sac::MutateStream({data, size}, random, MutateByLibFuzzer), data, max_size);
  return made > 0 ? made : LLVMFuzzerMutate(data, size, max_size);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* a, std::size_t a_size, const std::uint8_t* b,
                                                 std::size_t b_size, std::uint8_t* out, std::size_t max_size,
                                                 unsigned int seed) {
  std::mt19937 random(seed);
  std::vector<sac::Packet> packets = sac::CutPackets({a, a_size});
  const std::vector<sac::Packet> others = sac::CutPackets({b, b_size});
  if (packets.empty() || others.empty()) return 0;
  const sac::Packet& other = others[random() % others.size()];
  sac::Packet& packet = packets[random() % packets.size()];
  if (random() % 2) {
    packet = other;
  } else {  // the head of one, the tail of the other
    const std::size_t cut = random() % (std::min(packet.payload.size(), other.payload.size()) + 1);
    packet.payload.resize(cut);
    packet.payload.insert(packet.payload.end(), other.payload.begin() + static_cast<std::ptrdiff_t>(cut),
                          other.payload.end());
  }
  return Give(sac::Join(packets), out, max_size);
}

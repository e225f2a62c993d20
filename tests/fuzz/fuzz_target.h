// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

#include "sac/limits.h"

// A target tries one input: libFuzzer calls it with what it makes up, replay_main.cpp with files.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

// Ends the program: what holds of every input does not hold of this one.
#define FUZZ_REQUIRE(condition)                                                    \
  do {                                                                             \
    if (!(condition)) {                                                            \
      std::fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                \
    }                                                                              \
  } while (0)

namespace sac {

// What one input may spend: hundreds of them a second are wanted.
inline Limits FuzzLimits() {
  Limits limits;
  limits.vertices = 200;
  limits.expert.triangles = 400;
  limits.expert.harmonics = 60;
  limits.expert.frames_per_group = 32;
  limits.expert.packet_bytes = 1 << 16;
  limits.expert.group_values = 1 << 17;
  limits.expert.basis_values = 1 << 14;
  limits.expert.factor_values = 1 << 14;
  limits.memory = 1 << 24;
  limits.work = 2e7;
  limits.expert.free_work = 1e7;
  limits.expert.work_per_byte = 1e4;
  limits.expert.frame_work = 1e6;
  return limits;
}

// Choices out of an input, from its front; zeros when it is used up.
class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint8_t U8() {
    if (bytes_.empty()) return 0;
    const std::uint8_t b = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return b;
  }
  std::uint16_t U16() {
    const std::uint32_t low = U8(), high = U8();
    return static_cast<std::uint16_t>(low | high << 8);
  }
  std::uint32_t U32() {
    const std::uint32_t low = U16(), high = U16();
    return low | high << 16;
  }
  // Below `end`, which is at most 256.
  std::uint32_t Below(std::uint32_t end) { return U8() % end; }
  bool Flag() { return (U8() & 1) != 0; }
  // From -128 to 127.
  int Signed() { return static_cast<std::int8_t>(U8()); }

  std::size_t left() const { return bytes_.size(); }
  std::span<const std::uint8_t> rest() const { return bytes_; }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace sac

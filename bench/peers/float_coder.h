// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/range_coder.h"
#include "sac/mesh.h"

namespace sac::bench {

// Codes floats without loss. Each coordinate is the difference to the vertex before, both taken as ordered integers.
// The number of bits of the difference is coded adaptively, then the bits.
template <class Coder>
void CodeFloats(Coder& coder, std::vector<Vec3f>& values) {
  std::array<std::array<BitModel, 33>, 3> models;
  std::array<std::uint32_t, 3> last{};
  // Maps the bits of ascending floats to ascending integers, and back.
  const auto fold = [](std::uint32_t x) { return x >> 31 != 0 ? ~x : x | 0x80000000u; };
  const auto unfold = [](std::uint32_t x) { return x >> 31 != 0 ? x & 0x7fffffffu : ~x; };
  for (Vec3f& value : values) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::uint32_t difference = fold(std::bit_cast<std::uint32_t>(value[a])) - last[a];
      std::uint32_t zigzag = difference << 1 ^ (difference >> 31 != 0 ? 0xffffffffu : 0);
      int width = Coder::kDecodes ? 0 : std::bit_width(zigzag);
      for (int i = 0; i < 32; ++i) {
        bool more = i < width;
        coder.Bit(models[a][static_cast<std::size_t>(i)], more);
        if (!more) break;
        if constexpr (Coder::kDecodes) width = i + 1;
      }
      std::uint32_t high = zigzag >> 16, low = zigzag & 0xffff;
      if (width > 16) coder.Raw(high, width - 16);
      coder.Raw(low, std::min(width, 16));
      if constexpr (Coder::kDecodes) {
        zigzag = (width > 16 ? high << 16 : 0) | low;
        last[a] += zigzag >> 1 ^ ((zigzag & 1) != 0 ? 0xffffffffu : 0);
        value[a] = std::bit_cast<float>(unfold(last[a]));
      } else {
        last[a] += difference;
      }
    }
  }
}

}  // namespace sac::bench

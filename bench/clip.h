// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sac/clip.h"

namespace sac::bench {

inline constexpr std::uint32_t kFrames = 256;  // two groups of the default settings

// A clip and its stream at the default settings.
struct CodedClip {
  Clip clip;
  std::vector<std::uint8_t> stream;
};

// A synthetic walker, made once for each number of vertices. Ends the program when that fails.
const CodedClip& WalkerClip(std::uint32_t vertices);

}  // namespace sac::bench

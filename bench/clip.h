// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sac/clip.h"

namespace sac::bench {

inline constexpr std::uint32_t kFrames = 256;  // two groups of the default settings

// A clip and its stream, which is encoded with the default settings.
struct CodedClip {
  Clip clip;
  std::vector<std::uint8_t> stream;
};

// A synthetic walker of about `vertices` vertices. It is made and encoded by the first call for each number of
// vertices. Ends the program when that fails.
const CodedClip& WalkerClip(std::uint32_t vertices);

}  // namespace sac::bench

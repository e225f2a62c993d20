#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sac/mesh.h"

namespace sac::bench {

inline constexpr std::uint32_t kFrames = 256;  // two groups of the default settings

// A synthetic walker and its stream at the default settings.
struct Clip {
  Mesh mesh;
  std::vector<Positions> frames;
  std::vector<std::uint8_t> stream;
};

// Made once for each number of vertices; ends the program when that fails.
const Clip& WalkerClip(std::uint32_t vertices);

}  // namespace sac::bench

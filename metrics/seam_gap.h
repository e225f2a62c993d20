// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// Measures how far vertices part that are one point in the original: along seams of texture coordinates or of normals
// many files have a vertex several times, and a hole shows where the copies decode to different places. Neither KG nor
// STED sees it, for the copies share no edge.
class SeamGap {
 public:
  // Takes the next frame. Both must have as many positions as the first, in the same vertex order.
  void Add(const Positions& original, const Positions& decoded);

  // The largest distance, model units, between the decoded positions of two vertices that coincide in every original
  // frame so far; of several copies each is compared with the first. 0 if there are none.
  double Value() const;

 private:
  // Two vertices that coincide in all frames so far, and the largest distance of their decoded positions.
  struct Pair {
    std::uint32_t first, second;
    double gap2;
  };

  std::vector<Pair> pairs_;
  bool begun_ = false;
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// Finds the vertices that are at one place in every frame of a clip: their coordinates are equal numbers.
class CoincidentVertices {
 public:
  // Takes a frame, all of which have as many vertices, at finite places. The time is linear in them but for the first
  // frame, which is sorted.
  void Add(std::span<const Vec3f> positions);

  // Whether some vertices coincide in all frames so far.
  bool any() const { return !others_.empty(); }
  // Of each vertex the lowest that it coincides with in all frames, which may be itself. Empty where none coincide.
  std::vector<std::uint32_t> Lowest() const;

 private:
  bool begun_ = false;
  std::vector<std::uint32_t> lowest_;  // of each vertex
  std::vector<std::uint32_t> others_;  // those that are not the lowest of theirs, ascending
};

}  // namespace sac

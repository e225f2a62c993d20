// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sac/distortion.h"
#include "sac/mesh.h"

namespace sac {

// Measures each connected component against its own size. The KG error of the whole says nothing of a small part in a
// large scene, or of one beside another that is parked far away.
class PartError {
 public:
  // Every index of `triangles` must be below `vertices`.
  PartError(std::span<const Triangle> triangles, std::size_t vertices);

  // Takes the next frame. Both must have `vertices` positions, in the same vertex order.
  void Add(const Positions& original, const Positions& decoded);

  // The component of the largest error against its size: 100 sqrt(sum |decoded - original|^2 / sum |original - c|^2),
  // percent, over its vertices and all frames, c their mean in each frame. Components without extent are left out.
  PartDistortion Worst() const;

 private:
  struct Part {
    std::uint32_t first = 0;     // its smallest vertex
    std::uint32_t vertices = 0;  // how many it has
    double error2 = 0, spread2 = 0, max_error2 = 0;
  };
  // Of one frame: the sum of the vertices' offsets from the part's first, and of their squares.
  struct Sums {
    std::array<double, 3> sum = {};
    double square = 0;
  };

  std::vector<std::uint32_t> labels_;  // of each vertex, its part
  std::vector<Part> parts_;
  std::vector<Sums> sums_;
};

}  // namespace sac

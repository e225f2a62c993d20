// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// A vertex position with the precision of a file of text.
using Vec3d = std::array<double, 3>;

// Faces of any number of corners, one after the other: face j has the corners from ends[j - 1] (0 for the first face)
// to ends[j], and vertices[corner] is the index of a corner's vertex.
struct Faces {
  std::vector<std::uint32_t> ends, vertices;

  std::size_t size() const { return ends.size(); }
  std::uint32_t begin(std::size_t face) const { return face == 0 ? 0 : ends[face - 1]; }
  bool operator==(const Faces&) const = default;
};

}  // namespace sac

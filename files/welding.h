// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "files/faces.h"

namespace sac {

// Which corners of a triangle soup are one vertex: those at equal positions, in every frame that was added. Memory is
// that of a frame.
class Welding {
 public:
  // `corners` are the positions of a frame's corners, as many in each. Corners that were one vertex and part in this
  // frame become several. NaN is equal to the same NaN, and the two zeros to each other.
  void Add(const std::vector<Vec3d>& corners);

  // The number of vertices, which are numbered in the order of their first corners.
  std::size_t size() const { return first_corner_.size(); }

  // The vertex of each corner.
  const std::vector<std::uint32_t>& vertices() const { return vertices_; }

  // One value per vertex of one per corner, its first corner's.
  template <typename T>
  std::vector<T> Gather(const std::vector<T>& of_corners) const {
    std::vector<T> values;
    values.reserve(size());
    for (const std::uint32_t corner : first_corner_) values.push_back(of_corners[corner]);
    return values;
  }

 private:
  std::vector<std::uint32_t> vertices_, first_corner_;
};

}  // namespace sac

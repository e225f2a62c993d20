// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// The rotation vector nearest to `previous` among those, whole turns apart, of the rotation by `angle` radians about
// the unit vector `axis`. Where the angle is too small for an axis of its own, the turns are about that of `previous`.
Eigen::Vector3d NearestTurn(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& previous);

// Unwraps the rotation vectors of triangles over a surface: neighbours across edges get the branches nearest to each
// other, beginning with the triangle that turns least. A surface that is twisted by more than half a turn then has
// vectors without a jump, whatever frame comes first.
class SurfaceUnwrapping {
 public:
  explicit SurfaceUnwrapping(std::span<const Triangle> triangles);

  // `vectors` are triangles x 3, radians, each of at most half a turn. Triangles of which `left_out` is 1 have no
  // rotation; they stay as they are and lead nowhere.
  void Unwrap(std::span<const std::uint8_t> left_out, Eigen::Ref<Eigen::MatrixXd> vectors) const;

 private:
  // The neighbours of triangle j are neighbours_[offsets_[j]] to neighbours_[offsets_[j + 1] - 1].
  std::vector<std::uint32_t> offsets_, neighbours_;
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "geometry/laplacian.h"

namespace sac {

// A rotation R and a translation t about a given centre: x becomes R (x - centre) + centre + t.
struct RigidFit {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  double residual;  // root mean square distance left
};

// The motion that brings the points `from` nearest to the points `to` in the least squares (Kabsch 1976).
RigidFit FitRigid(const PositionMatrix& from, const PositionMatrix& to, const Eigen::RowVector3d& centre);

}  // namespace sac

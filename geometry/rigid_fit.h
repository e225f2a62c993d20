#pragma once

#include <Eigen/Core>

#include "geometry/laplacian.h"

namespace sac {

// The rotation R and translation t that bring `from` nearest to `to` in the least squares: to ~ R (from - centre) +
// centre + t (Kabsch 1976).
struct RigidFit {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  double residual;  // root mean square distance left
};

RigidFit FitRigid(const PositionMatrix& from, const PositionMatrix& to, const Eigen::RowVector3d& centre);

}  // namespace sac

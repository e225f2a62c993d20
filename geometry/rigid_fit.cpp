// SPDX-License-Identifier: Apache-2.0
#include "geometry/rigid_fit.h"

#include "geometry/triangle_fields.h"

namespace sac {

RigidFit FitRigid(const PositionMatrix& from, const PositionMatrix& to, const Eigen::RowVector3d& centre) {
  const Eigen::RowVector3d a = from.colwise().mean(), b = to.colwise().mean();
  const PositionMatrix x = from.rowwise() - a, y = to.rowwise() - b;
  const Eigen::Matrix3d r = PolarRotation(y.transpose() * x);
  const Eigen::Vector3d t = (b - centre).transpose() - r * (a - centre).transpose();
  return {r, t, std::sqrt((y - x * r.transpose()).squaredNorm() / static_cast<double>(x.rows()))};
}

}  // namespace sac

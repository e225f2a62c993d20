// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace sac {

// The rotation about the axis `u` by |u| radians (Rodrigues' formula), which is the exponential of u's cross-product
// matrix.
inline Eigen::Matrix3d RotationOf(const Eigen::Vector3d& u) {
  const double square = u.squaredNorm();
  const double angle = std::sqrt(square);
  // sin(t) / t and (1 - cos(t)) / t^2, by their series near zero.
  const double s = angle > 1e-4 ? std::sin(angle) / angle : 1 - square / 6;
  const double c = angle > 1e-4 ? (1 - std::cos(angle)) / square : 0.5 - square / 24;
  const double x = u[0], y = u[1], z = u[2];
  Eigen::Matrix3d r;
  r << 1 - c * (y * y + z * z), c * x * y - s * z, c * x * z + s * y,  //
      c * x * y + s * z, 1 - c * (x * x + z * z), c * y * z - s * x,   //
      c * x * z - s * y, c * y * z + s * x, 1 - c * (x * x + y * y);
  return r;
}

// The deformation gradient J = exp(u) (I + p) (spec.md 6.5.2). `channels` are the nine motion channels in order: the
// rotation vector u (radians), then xx, yy, zz, xy, xz and yz of the symmetric strain p.
inline Eigen::Matrix3d DeformationGradient(const double channels[9]) {
  const double* const f = channels;
  Eigen::Matrix3d stretch;
  stretch << 1 + f[3], f[6], f[7],  //
      f[6], 1 + f[4], f[8],         //
      f[7], f[8], 1 + f[5];
  return RotationOf({f[0], f[1], f[2]}) * stretch;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace sac {

// The rotation about the axis `u` by |u| radians (Rodrigues' formula), which is the exponential of u's cross-product
// matrix.
Eigen::Matrix3d RotationOf(const Eigen::Vector3d& u);

// The deformation gradient J = exp(u) (I + p) (spec.md 6.5.2). `channels` are the nine motion channels in order: the
// rotation vector u (radians), then xx, yy, zz, xy, xz and yz of the symmetric strain p.
Eigen::Matrix3d DeformationGradient(const double channels[9]);

}  // namespace sac

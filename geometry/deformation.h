#pragma once

#include <Eigen/Core>

namespace sac {

// Rotation about the axis u by |u| radians (Rodrigues' formula), the exponential of u's cross-product matrix.
Eigen::Matrix3d RotationOf(const Eigen::Vector3d& u);

// J = exp(u) (I + p), from the nine motion channels in order: u (3), then p's xx, yy, zz, xy, xz, yz (spec.md 6.5.2).
Eigen::Matrix3d DeformationGradient(const double channels[9]);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "geometry/laplacian.h"
#include "geometry/surface_unwrapping.h"
#include "sac/mesh.h"

namespace sac {

// Measures the motion fields of a deformation at triangles: the nine channels of log-rotation and stretch, from the
// polar decomposition J = U P of each deformation gradient (Wang et al. 2015, section 3.1). The last frame's rotations
// are kept, since a rotation vector is unwrapped in time: the branch nearest to the frame before is taken among those 2
// pi apart. After Restart() it is unwrapped over the surface instead.
class TriangleFields {
 public:
  explicit TriangleFields(std::span<const Triangle> triangles);

  // Forgets all frames before: the next result depends on its own frame alone.
  void Restart();

  // Returns the fields of the deformation from `reference` to `deformed`, triangles x 9. Rows of triangles that are
  // degenerate in `reference` are zero, and so are their areas().
  const Eigen::MatrixXd& Measure(const PositionMatrix& reference, const PositionMatrix& deformed);

  // The area of each triangle in the reference last measured.
  const Eigen::VectorXd& areas() const { return areas_; }

 private:
  // Makes the rotations of fields_, of half a turn at most, agree with their neighbours'.
  void UnwrapOverSurface();

  std::span<const Triangle> triangles_;
  bool restarted_ = false;
  std::unique_ptr<SurfaceUnwrapping> surface_;  // made where it is needed
  Eigen::MatrixXd fields_;
  Eigen::VectorXd areas_;
};

// The rotation U of the polar decomposition J = U P where det J >= 0, and the rotation nearest to `j` otherwise.
Eigen::Matrix3d PolarRotation(const Eigen::Matrix3d& j);

// The rotation vector of `r` nearest to `previous` among the branches 2 pi apart.
Eigen::Vector3d UnwrappedLog(const Eigen::Matrix3d& r, const Eigen::Vector3d& previous);

}  // namespace sac

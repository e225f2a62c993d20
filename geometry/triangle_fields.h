#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/laplacian.h"
#include "sac/mesh.h"

namespace sac {

// Measures the motion fields of a deformation at triangles: the nine channels of log-rotation and stretch, from the
// polar decomposition J = U P of each deformation gradient (Wang et al. 2015, section 3.1). Keeps the last frame's
// rotations, because a rotation vector is unwrapped in time: of the branches 2 pi apart the one nearest to the frame
// before.
class TriangleFields {
 public:
  explicit TriangleFields(std::span<const Triangle> triangles);

  // triangles x 9, of the deformation reference -> deformed. Rows of triangles that are degenerate in `reference` are
  // zero, and so are their areas().
  const Eigen::MatrixXd& Measure(const PositionMatrix& reference, const PositionMatrix& deformed);

  // Per triangle, of the reference last measured.
  const Eigen::VectorXd& areas() const { return areas_; }

 private:
  std::span<const Triangle> triangles_;
  Eigen::MatrixXd fields_;
  Eigen::VectorXd areas_;
};

// The rotation U of the polar decomposition J = U P, for det J >= 0; the nearest rotation otherwise.
Eigen::Matrix3d PolarRotation(const Eigen::Matrix3d& j);

// The rotation vector of `r` nearest to `previous` among the branches 2 pi apart.
Eigen::Vector3d UnwrappedLog(const Eigen::Matrix3d& r, const Eigen::Vector3d& previous);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/components.h"
#include "geometry/laplacian.h"
#include "geometry/sparse_cholesky.h"

namespace sac {

using DeformationGradients = std::vector<Eigen::Matrix3d>;  // one a vertex

// Finds the vertices whose edges are those of a reference shape after deformation (spec.md 6.5.3): the minimum of
//   sum over edges (a, b) of w_ab || x_a - x_b - (J_a + J_b) / 2 (y_a - y_b) ||^2,
// which is the Poisson problem of Sumner and Popovic 2004 with the deformation gradients J at vertices.
class PoissonSystem {
 public:
  // `edges` and `components` belong to the mesh; the vertices of a component are consecutive. `masses` holds the share
  // of each vertex in the area. All three must outlive the system.
  PoissonSystem(const EdgeList& edges, std::span<const Component> components, const Eigen::VectorXd& masses);

  // Sets the reference shape y and its cotangent weights, one for each edge. Returns false when the factorization
  // fails.
  bool SetReference(const PositionMatrix& reference, std::vector<double> weights);

  // Returns the deformed positions for `gradients`, one a vertex. The area-weighted centroid of each component is that
  // of the reference. The result stays valid until the next call.
  const PositionMatrix& Solve(const DeformationGradients& gradients);

 private:
  const EdgeList& edges_;
  std::span<const Component> components_;
  const Eigen::VectorXd& masses_;
  PositionMatrix reference_;
  std::vector<double> weights_;
  Eigen::SparseMatrix<double> matrix_;
  SparseCholesky solver_;
  bool analyzed_ = false;
  PositionMatrix right_side_;
  RowMatrix columns_;
  std::vector<double> scratch_;  // of the solver
  PositionMatrix solution_;
};

}  // namespace sac

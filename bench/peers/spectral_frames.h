// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/components.h"
#include "geometry/laplacian.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac::bench {

// What Wang et al. 2015 ("Spectral animation compression", JCST 30(3)) derive from the first frame: manifold harmonics
// H, exact ones, and fields at triangles as means of fields at vertices, C H.
class SpectralBasis {
 public:
  // `order`: the vertices of the mesh with those of each component in a run; everything else is in that order.
  static std::vector<std::uint32_t> ComponentOrder(std::span<const Triangle> triangles, std::size_t vertices);

  // `bases` over all components, shared by vertices, at least one each.
  Status Build(std::vector<Triangle> triangles, const PositionMatrix& first_frame, std::uint32_t bases);

  // The coefficients (bases x channels) whose fields are nearest to those of the triangles, every triangle alike.
  Eigen::MatrixXd Project(const Eigen::MatrixXd& fields) const {
    return normal_.solve(at_triangles_.transpose() * fields);
  }
  Eigen::MatrixXd Fields(const Eigen::MatrixXd& coefficients) const { return at_triangles_ * coefficients; }

  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<Component>& components() const { return components_; }
  Eigen::Index bases() const { return at_triangles_.cols(); }

 private:
  std::vector<Triangle> triangles_;
  std::vector<Component> components_;
  Eigen::MatrixXd at_triangles_;  // C H
  Eigen::LDLT<Eigen::MatrixXd> normal_;
};

// The vertices that minimize, over the triangles of `reference`, area times || grad x - J ||^2 (Sumner and Popovic
// 2004), J being one 3 x 3 matrix a triangle. Each component's mean vertex becomes its row of `centres`.
Status SolveGradients(const SpectralBasis& basis, const PositionMatrix& reference,
                      const std::vector<Eigen::Matrix3d>& gradients, const PositionMatrix& centres,
                      PositionMatrix& out);

// The mean vertex of each component.
PositionMatrix Centres(const SpectralBasis& basis, const PositionMatrix& positions);

}  // namespace sac::bench

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

// The basis that Wang et al. 2015 ("Spectral animation compression", JCST 30(3)) derive from the first frame: the exact
// manifold harmonics H at the vertices, and C H at the triangles, where each triangle has the mean of its vertices.
class SpectralBasis {
 public:
  // The vertices of the mesh in an order in which each component is a run. Everything else here is in that order.
  static std::vector<std::uint32_t> ComponentOrder(std::span<const Triangle> triangles, std::size_t vertices);

  // Computes `bases` harmonics in all. Components share them in proportion to their vertices; each gets at least one.
  Status Build(std::vector<Triangle> triangles, const PositionMatrix& first_frame, std::uint32_t bases);

  // The coefficients (bases x channels) nearest to `fields` (triangles x channels), with the same weight for every
  // triangle.
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

// Computes the vertices x that minimize the sum over the triangles of `reference` of area * || grad x - J ||^2 (Sumner
// and Popovic 2004), where `gradients` has the 3 x 3 matrix J of each triangle. The mean vertex of each component is
// its row of `centres`.
Status SolveGradients(const SpectralBasis& basis, const PositionMatrix& reference,
                      const std::vector<Eigen::Matrix3d>& gradients, const PositionMatrix& centres,
                      PositionMatrix& out);

// The mean vertex of each component.
PositionMatrix Centres(const SpectralBasis& basis, const PositionMatrix& positions);

}  // namespace sac::bench

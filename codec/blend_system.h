// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/blend.h"
#include "geometry/components.h"
#include "geometry/edges.h"
#include "geometry/laplacian.h"
#include "geometry/sparse_cholesky.h"

namespace sac {

// Finds the blend whose edges are those of a reference shape after deformation (spec.md 6.5.3): the minimum of
//   sum over edges (a, b) of w_ab || x_a - x_b - sum over handles i of (w_i(a) + w_i(b)) / 2 J_i (y_a - y_b) ||^2
//   + r sum over handles i of || A_i - J_i ||^2,
// which is the Poisson problem of Sumner and Popovic 2004 within the blends, with the deformation gradients J at
// handles. Where every vertex is a handle it is that problem itself.
class BlendSystem {
 public:
  // Sets the reference shape y and the weight of each edge. Solve() needs Analyze(), once, and Factorize() after it.
  void SetReference(const Blend& blend, const EdgeGraph& graph, std::span<const double> weights,
                    const Eigen::VectorXd& masses, const PositionMatrix& reference);
  // Finds the order of elimination, which holds for further reference shapes. Returns false when the factor exceeds
  // `max_size`.
  bool Analyze(const FactorSize& max_size = {});
  // Returns false when the matrix is singular.
  bool Factorize();

  // The matrix S of component `c`'s functions: their Laplacian with r on the diagonal; its lower triangle.
  Eigen::SparseMatrix<double> Stiffness(std::size_t c) const;
  const FactorSize& size() const { return solver_.size(); }
  // Multiplications of a solution.
  double work() const { return 6 * static_cast<double>(size().values) + 3 * static_cast<double>(pull_.nonZeros()); }
  // Bytes beside the factor.
  std::uint64_t memory() const { return 12 * static_cast<std::uint64_t>(pull_.nonZeros() + matrix_.nonZeros()); }

  // What a solution needs in memory, kept from call to call.
  struct Scratch {
    RowMatrix gradients;
    std::vector<double> solver;
  };
  // Sets `z`, functions x 3, to the solution for `gradients`, one a handle. The area-weighted centroid of each
  // component is that of the reference.
  void Solve(const DeformationGradients& gradients, Scratch& scratch, RowMatrix& z) const;
  // Sets `z` to what gives the reference shape.
  void Rest(RowMatrix& z) const { z = rest_; }

 private:
  // The matrix with every component tied to the origin, since each is free to move as a whole.
  Eigen::SparseMatrix<double> Tied() const;

  std::vector<Component> functions_;
  Eigen::SparseMatrix<double> matrix_;                 // S of all components, lower triangle
  Eigen::SparseMatrix<double, Eigen::RowMajor> pull_;  // P of all components
  Eigen::VectorXd centroid_;                           // of each function its share of its component's centroid
  std::vector<std::uint32_t> translations_;            // functions that move a component as a whole, by component
  std::vector<std::size_t> first_translation_;
  RowMatrix rest_;
  SparseCholesky solver_;
};

}  // namespace sac

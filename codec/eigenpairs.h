// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>

namespace sac {

struct EigenPairs {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // one column each, orthonormal
};

// Computes the `count` smallest eigenpairs of a symmetric, positive semidefinite matrix given by its lower triangle.
// Eigenvalues of manifold harmonics are expected: about 4 pi apart, the smallest 0. Returns false when they do not
// converge.
bool SmallestEigenpairs(const Eigen::SparseMatrix<double>& lower, std::uint32_t count, EigenPairs& out);

// The estimated number of multiplications of that for a matrix of `size` rows, and the bytes that it takes.
double EigenpairsWork(double size, double count);
double EigenpairsMemory(double size, double count);

// A fixed generic number in [-1, 1) for each index (spec.md 6.4.3).
double Generic(std::uint32_t i);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cstdint>
#include <limits>
#include <vector>

namespace sac {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// The cost of a factorization: the values below the diagonal of the factor, of 12 bytes each, and approximately the
// number of multiplications.
struct FactorSize {
  std::uint64_t values = std::numeric_limits<std::int32_t>::max();
  double work = std::numeric_limits<double>::infinity();
};

// The factorization L D L^T of a sparse symmetric matrix, of which only the lower triangle is read. The size of L
// depends on the connectivity of the mesh alone, and connectivity that is not a surface's makes L nearly dense. The
// size is therefore counted before anything is allocated; Eigen itself counts in 32 bits and would write out of bounds.
class SparseCholesky : private Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  // Orders the pattern of `matrix` and counts the factor. Returns false when the factor exceeds `limit` in size or
  // work.
  bool Analyze(const Matrix& matrix, const FactorSize& limit = {});
  // Factorizes a matrix of the pattern that was analyzed. Returns false when it is singular.
  bool Factorize(const Matrix& matrix);

  const FactorSize& size() const { return size_; }
  using Base::solve;

  // Solves A X = B and stores X in place of B. It is faster than solve(), which reads the factor again for each column.
  void SolveInPlace(RowMatrix& columns) const {
    std::vector<double> scratch;
    SolveInPlace(columns, scratch);
  }
  // Does the same with `scratch` for intermediate values, which keeps its memory from call to call.
  void SolveInPlace(RowMatrix& columns, std::vector<double>& scratch) const;

 private:
  template <int kColumns>
  void SolveBlocks(RowMatrix& columns, std::vector<double>& scratch) const;
  // Returns false as soon as the count exceeds `limit`.
  bool Count(const CholMatrixType& ordered, const FactorSize& limit);

  FactorSize size_;
};

}  // namespace sac

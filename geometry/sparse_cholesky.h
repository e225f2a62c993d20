#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cstdint>
#include <limits>

namespace sac {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// What a factorization takes: values below the diagonal of the factor, of 12 bytes each, and multiplications, about.
struct FactorSize {
  std::uint64_t values = std::numeric_limits<std::int32_t>::max();
  double work = std::numeric_limits<double>::infinity();
};

// L D L^T of a sparse symmetric matrix, of which only the lower triangle is read. How much L fills up depends on the
// mesh alone, and connectivity that is no surface's makes it as good as dense. So its size is counted before it is
// allocated. Eigen counts in 32 bits, and writes out of bounds when they are too few.
class SparseCholesky : private Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  // Orders and counts for the pattern of `matrix`. False when the factor is larger than `most`, in either.
  bool Analyze(const Matrix& matrix, const FactorSize& most = {});
  // Of a matrix of the same pattern. False when it is singular.
  bool Factorize(const Matrix& matrix);

  const FactorSize& size() const { return size_; }
  using Base::solve;

  // X of A X = B, in place of B: faster than solve(), which reads the factor again for each column.
  void SolveInPlace(RowMatrix& columns) const;

 private:
  template <int kColumns>
  void SolveBlocks(RowMatrix& columns) const;
  // False as soon as there is more than `most`.
  bool Count(const CholMatrixType& ordered, const FactorSize& most);

  FactorSize size_;
};

}  // namespace sac

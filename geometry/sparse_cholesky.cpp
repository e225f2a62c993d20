// SPDX-License-Identifier: Apache-2.0
#include "geometry/sparse_cholesky.h"

#include <algorithm>

namespace sac {

// As Eigen's symbolic factorization does (T. Davis, "Algorithm 849: a concise sparse Cholesky factorization package",
// 2005): row k of the factor is what the paths from its entries to the root of the elimination tree pass.
bool SparseCholesky::Count(const CholMatrixType& ordered, const FactorSize& limit) {
  size_ = {0, 0};
  const auto n = static_cast<std::size_t>(ordered.cols());
  std::vector<int> parent(n, -1), reached(n, -1);
  std::vector<std::uint32_t> below(n, 0);  // values of each column so far
  for (int k = 0; k < static_cast<int>(n); ++k) {
    reached[static_cast<std::size_t>(k)] = k;
    for (CholMatrixType::InnerIterator it(ordered, k); it; ++it) {
      if (it.index() >= k) continue;
      for (auto i = static_cast<std::size_t>(it.index()); reached[i] != k; i = static_cast<std::size_t>(parent[i])) {
        if (parent[i] < 0) parent[i] = k;
        reached[i] = k;
        ++size_.values;
        size_.work += 2.0 * ++below[i] + 1;
      }
    }
    if (size_.values > limit.values || size_.work > limit.work) return false;
  }
  return true;
}

bool SparseCholesky::Analyze(const Matrix& matrix, const FactorSize& limit) {
  CholMatrixType storage(matrix.rows(), matrix.cols());
  ConstCholMatrixPtr ordered = nullptr;
  ordering(matrix, ordered, storage);
  if (!Count(*ordered, limit)) return false;
  analyzePattern_preordered(*ordered, true);
  return true;
}

bool SparseCholesky::Factorize(const Matrix& matrix) {
  factorize(matrix);
  return info() == Eigen::Success;
}

template <int kColumns>
void SparseCholesky::SolveBlocks(RowMatrix& columns, std::vector<double>& scratch) const {
  using Row = Eigen::Matrix<double, 1, kColumns>;
  const auto& below = m_matrix;  // the factor without its diagonal of ones
  scratch.resize(static_cast<std::size_t>(columns.rows()) * kColumns);
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kColumns, Eigen::RowMajor>> x(scratch.data(), columns.rows(),
                                                                                 kColumns);
  for (Eigen::Index first = 0; first < columns.cols(); first += kColumns) {
    const Eigen::Index count = std::min<Eigen::Index>(kColumns, columns.cols() - first);
    x.rightCols(kColumns - count).setZero();
    x.leftCols(count) = m_P * columns.middleCols(first, count);
    for (Eigen::Index k = 0; k < x.rows(); ++k) {
      const Row value = x.row(k);
      for (CholMatrixType::InnerIterator it(below, k); it; ++it) x.row(it.index()) -= it.value() * value;
    }
    x.array().colwise() /= m_diag.array();
    for (Eigen::Index k = x.rows() - 1; k >= 0; --k) {
      Row value = x.row(k);
      for (CholMatrixType::InnerIterator it(below, k); it; ++it) value -= it.value() * x.row(it.index());
      x.row(k) = value;
    }
    columns.middleCols(first, count) = m_Pinv * x.leftCols(count);
  }
}

void SparseCholesky::SolveInPlace(RowMatrix& columns, std::vector<double>& scratch) const {
  if (columns.cols() <= 4) {
    SolveBlocks<4>(columns, scratch);
  } else {
    SolveBlocks<8>(columns, scratch);
  }
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/eigenpairs.h"

#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <stdexcept>

#include "geometry/sparse_cholesky.h"

namespace sac {
namespace {

constexpr double kDenseSize = 96;  // up to this size, a dense solver for all eigenpairs is as quick as Lanczos
constexpr int kSpareVectors = 20;  // Lanczos vectors beside two for each wanted eigenpair
// Surfaces take 1 or 2 restarts. Shapes that are nearly a long path have almost equal eigenvalues and take hundreds.
constexpr int kUsualRestarts = 5, kMaxRestarts = 60;

// The operation x -> (A - sigma I)^-1 x in the form that Spectra asks for.
class ShiftSolve {
 public:
  using Scalar = double;
  explicit ShiftSolve(const Eigen::SparseMatrix<double>& lower) : matrix_(lower) {}
  Eigen::Index rows() const { return matrix_.rows(); }
  Eigen::Index cols() const { return matrix_.cols(); }
  void set_shift(double sigma) {
    Eigen::SparseMatrix<double> shifted;
    shifted = matrix_;  // Eigen's copy constructor would lose memory when there is too little
    for (Eigen::Index i = 0; i < rows(); ++i) shifted.coeffRef(i, i) -= sigma;
    ok_ = solver_.Analyze(shifted) && solver_.Factorize(shifted);
  }
  void perform_op(const double* in, double* out) const {
    Eigen::Map<Eigen::VectorXd>(out, rows()) = solver_.solve(Eigen::Map<const Eigen::VectorXd>(in, rows()));
  }
  bool ok() const { return ok_; }

 private:
  const Eigen::SparseMatrix<double>& matrix_;
  SparseCholesky solver_;
  bool ok_ = false;
};

// How the eigenpairs of a matrix are computed.
struct Method {
  Method(double size, double count)
      : basis(std::min(2 * count + kSpareVectors, size)), dense(size <= kDenseSize || basis == size) {}
  double basis;  // number of Lanczos vectors
  bool dense;    // whether a dense solver computes all eigenpairs at once
};

}  // namespace

bool SmallestEigenpairs(const Eigen::SparseMatrix<double>& lower, std::uint32_t count, EigenPairs& out) {
  const Eigen::Index n = lower.rows(), wanted = count;
  const Method method(static_cast<double>(n), count);
  if (method.dense) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{Eigen::MatrixXd(lower)};
    if (solver.info() != Eigen::Success) return false;
    out = {solver.eigenvalues().head(wanted), solver.eigenvectors().leftCols(wanted)};
    return true;
  }
  // Masses sum to 1 over the mesh, so the eigenvalues of a surface are about 4 pi apart (Weyl's law), and a shift of -1
  // is small beside that.
  ShiftSolve operation(lower);
  Spectra::SymEigsShiftSolver<ShiftSolve> solver(operation, wanted, static_cast<Eigen::Index>(method.basis), -1.0);
  if (!operation.ok()) return false;
  Eigen::VectorXd start(n);
  for (Eigen::Index i = 0; i < n; ++i) start[i] = Generic(static_cast<std::uint32_t>(i));
  solver.init(start.data());
  try {
    solver.compute(Spectra::SortRule::LargestMagn, kMaxRestarts, 1e-13, Spectra::SortRule::SmallestAlge);
  } catch (const std::runtime_error&) {  // Spectra throws it when one of its small eigenproblems does not converge
    return false;
  }
  if (solver.info() != Spectra::CompInfo::Successful) return false;
  out = {solver.eigenvalues(), solver.eigenvectors()};
  return true;
}

double EigenpairsWork(double size, double count) {
  const Method method(size, count);
  if (method.dense) return 10 * size * size * size;
  return kUsualRestarts * method.basis * size * method.basis;
}

double EigenpairsMemory(double size, double count) {
  const Method method(size, count);
  return sizeof(double) * (size <= kDenseSize ? 4 * size * size : size * method.basis);
}

double Generic(std::uint32_t i) { return static_cast<double>((i + 1) * 2654435761u) / 2147483648.0 - 1.0; }

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/harmonics.h"

#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "codec/radial_functions.h"
#include "geometry/sparse_cholesky.h"

namespace sac {
namespace {

constexpr double kInhomogeneity = 0.1;
constexpr Eigen::Index kDenseSize = 96;    // up to this size, a dense solver for all eigenpairs is as quick as Lanczos
constexpr int kSpareVectors = 20;          // Lanczos vectors beside two for each wanted eigenpair
constexpr double kFunctionsMemory = 1000;  // bytes per vertex for the radial functions that reach it on a surface
constexpr double kFunctionMemory = 90;     // bytes for each value of a radial function
// Surfaces take 1 or 2 restarts. Shapes that are nearly a long path have almost equal eigenvalues and take hundreds.
constexpr int kUsualRestarts = 5, kMaxRestarts = 60;

// A fixed generic cubic polynomial of coordinates scaled to [0, 1], with values in [-1, 1] (spec.md 6.4.2).
double GenericCubic(const Eigen::Array3d& p) {
  const double x = p[0], y = p[1], z = p[2];
  return 0.31 * x - 0.23 * y + 0.17 * z + 0.19 * x * y - 0.29 * y * z + 0.13 * z * x + 0.11 * x * x * y -
         0.07 * y * y * z + 0.05 * z * z * x + 0.21 * x * x - 0.15 * z * z + 0.09 * y * y * y;
}

// A fixed generic number in [-1, 1) for each index (spec.md 6.4.3).
double Generic(std::uint32_t i) { return static_cast<double>((i + 1) * 2654435761u) / 2147483648.0 - 1.0; }

struct EigenPairs {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // one column each, orthonormal
};

bool Factorize(SparseCholesky& solver, const Eigen::SparseMatrix<double>& matrix) {
  return solver.Analyze(matrix) && solver.Factorize(matrix);
}
bool Factorize(Eigen::LLT<Eigen::MatrixXd>& solver, const Eigen::MatrixXd& matrix) {
  solver.compute(matrix);
  return solver.info() == Eigen::Success;
}

// The operation x -> (A - sigma I)^-1 x in the form that Spectra asks for. `Solver` is a Cholesky solver for matrices
// of the type of A.
template <class Matrix, class Solver>
class ShiftSolve {
 public:
  using Scalar = double;
  explicit ShiftSolve(const Matrix& lower) : matrix_(lower) {}
  Eigen::Index rows() const { return matrix_.rows(); }
  Eigen::Index cols() const { return matrix_.cols(); }
  void set_shift(double sigma) {
    Matrix shifted;
    shifted = matrix_;  // Eigen's copy constructor would lose memory when there is too little
    for (Eigen::Index i = 0; i < rows(); ++i) shifted.coeffRef(i, i) -= sigma;
    ok_ = Factorize(solver_, shifted);
  }
  void perform_op(const double* in, double* out) const {
    Eigen::Map<Eigen::VectorXd>(out, rows()) = solver_.solve(Eigen::Map<const Eigen::VectorXd>(in, rows()));
  }
  bool ok() const { return ok_; }

 private:
  const Matrix& matrix_;
  Solver solver_;
  bool ok_ = false;
};
using SparseShiftSolve = ShiftSolve<Eigen::SparseMatrix<double>, SparseCholesky>;
using DenseShiftSolve = ShiftSolve<Eigen::MatrixXd, Eigen::LLT<Eigen::MatrixXd>>;

// Computes the `count` smallest eigenpairs of a symmetric, positive semidefinite matrix given by its lower triangle.
// Returns false when they do not converge.
template <class Operation, class Matrix>
bool SmallestEigenpairs(const Matrix& lower, std::uint32_t count, EigenPairs& out) {
  const Eigen::Index n = lower.rows(), wanted = count, basis = std::min<Eigen::Index>(2 * wanted + kSpareVectors, n);
  if (n <= kDenseSize || basis == n) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{Eigen::MatrixXd(lower)};
    if (solver.info() != Eigen::Success) return false;
    out = {solver.eigenvalues().head(wanted), solver.eigenvectors().leftCols(wanted)};
    return true;
  }
  // Masses sum to 1 over the mesh, so the eigenvalues of a surface are about 4 pi apart (Weyl's law), and a shift of -1
  // is small beside that.
  Operation operation(lower);
  Spectra::SymEigsShiftSolver<Operation> solver(operation, wanted, basis, -1.0);
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

// Computes the smallest eigenpairs of L h = lambda D h. With h = D^-1/2 y they are those of D^-1/2 L D^-1/2.
bool ExactHarmonics(const Eigen::SparseMatrix<double>& laplacian, const Eigen::VectorXd& mass, std::uint32_t count,
                    EigenPairs& out) {
  const Eigen::VectorXd scale = mass.cwiseSqrt().cwiseInverse();
  Eigen::SparseMatrix<double> scaled;
  scaled = scale.asDiagonal() * laplacian * scale.asDiagonal();
  if (!SmallestEigenpairs<SparseShiftSolve>(scaled, count, out)) return false;
  out.vectors = scale.asDiagonal() * out.vectors;
  return true;
}

// Takes one step of inverse iteration, Y = (L + D)^-1 D H, and computes the Ritz vectors of the span of Y. The step
// separates parts of the surface that are near in space but far along the surface, which radial functions mix.
bool Refine(const Eigen::SparseMatrix<double>& laplacian, const Eigen::VectorXd& mass, RowMatrix functions,
            EigenPairs& out) {
  Eigen::SparseMatrix<double> shifted;
  shifted = laplacian;
  for (Eigen::Index i = 0; i < shifted.rows(); ++i) shifted.coeffRef(i, i) += mass[i];
  SparseCholesky solver;
  if (!Factorize(solver, shifted)) return false;
  RowMatrix& weighted = functions;  // reuses the memory, since this is one of the largest matrices
  weighted.array().colwise() *= mass.array();
  RowMatrix image = weighted;
  solver.SolveInPlace(image);
  // With (L + D) Y = D H, Y^T L Y = Y^T D H - Y^T D Y: symmetric, so their lower triangles are enough.
  Eigen::MatrixXd stiffness(image.cols(), image.cols()), gram(image.cols(), image.cols());
  stiffness.triangularView<Eigen::Lower>() = image.transpose() * weighted;
  weighted = mass.asDiagonal() * image;
  gram.triangularView<Eigen::Lower>() = image.transpose() * weighted;
  stiffness.triangularView<Eigen::Lower>() -= gram;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(stiffness, gram);
  if (ritz.info() != Eigen::Success) return false;
  weighted.resize(0, 0);
  out = {ritz.eigenvalues(), image * ritz.eigenvectors()};
  return true;
}

// Solves the same problem within the span of the columns of S = `functions` (Rayleigh-Ritz): S^T L S y = lambda S^T D S
// y, h = S y.
bool ReducedHarmonics(const Eigen::SparseMatrix<double>& laplacian, const Eigen::VectorXd& mass,
                      const Eigen::SparseMatrix<double>& functions, std::uint32_t count, EigenPairs& out) {
  // Assigned, not constructed: Eigen's constructors lose memory when there is too little.
  Eigen::SparseMatrix<double> full, image, weighted;
  full = laplacian.selfadjointView<Eigen::Lower>();
  image = full * functions;
  const Eigen::MatrixXd stiffness = functions.transpose() * image;
  weighted = mass.asDiagonal() * functions;
  const Eigen::LLT<Eigen::MatrixXd> gram(Eigen::MatrixXd(functions.transpose() * weighted));
  if (gram.info() != Eigen::Success) return false;
  Eigen::MatrixXd standard = gram.matrixL().solve(stiffness).transpose();
  standard = gram.matrixL().solve(standard).eval();
  standard = (standard + standard.transpose()).eval() / 2;
  if (!SmallestEigenpairs<DenseShiftSolve>(standard, count, out)) return false;
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows;
  rows = functions;
  const RowMatrix mixed = gram.matrixU().solve(out.vectors);
  return Refine(laplacian, mass, rows * mixed, out);
}

// The Laplacian of a component with unevenly scaled weights (spec.md 6.4.2), which splits the multiple eigenvalues of
// symmetric shapes.
Eigen::SparseMatrix<double> UnevenLaplacian(const LaplaceProblem& problem, const Component& c) {
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::max()), high = -low;
  const auto point = [](const GridPosition& g) { return Eigen::Array3d(g[0], g[1], g[2]); };
  for (const GridPosition& g : problem.grid.subspan(c.first, c.count)) {
    low = low.min(point(g));
    high = high.max(point(g));
  }
  const double extent = std::max(1.0, (high - low).maxCoeff());
  const EdgeRange range = EdgesOf(problem.edges, c.first, c.count);
  const auto ends = std::span(problem.edges.ends).subspan(range.begin, range.count);
  std::vector<double> uneven(ends.size());
  for (std::size_t e = 0; e < ends.size(); ++e) {
    const Eigen::Array3d middle = (point(problem.grid[ends[e][0]]) + point(problem.grid[ends[e][1]])) / 2;
    uneven[e] = problem.weights[range.begin + e] * (1 + kInhomogeneity * GenericCubic((middle - low) / extent));
  }
  return LaplacianMatrix(ends, uneven, c.first, c.count);
}

// Scales each harmonic to a mean square of 1 and gives it the sign of spec.md 6.4.3. The first harmonic is set to 1,
// its exact value.
void Normalize(const Eigen::VectorXd& mass, ComponentHarmonics& harmonics) {
  harmonics.eigenvalues[0] = 0;
  harmonics.vectors.col(0).setOnes();
  for (Eigen::Index k = 0; k < harmonics.vectors.cols(); ++k) {
    auto h = harmonics.vectors.col(k);
    double sign = 0;
    for (Eigen::Index v = 0; v < h.rows(); ++v) sign += Generic(static_cast<std::uint32_t>(v)) * h[v];
    const double mean_square = h.cwiseAbs2().dot(mass) / mass.sum();
    h *= (k > 0 && sign < 0 ? -1.0 : 1.0) / std::sqrt(mean_square);
  }
}

Status ComputeComponent(const LaplaceProblem& problem, std::uint32_t count, const Spare& spare,
                        ComponentHarmonics& out) {
  const Component& c = out.component;
  const Eigen::SparseMatrix<double> laplacian = UnevenLaplacian(problem, c);
  const Eigen::VectorXd mass = problem.masses.segment(c.first, c.count);

  const std::uint64_t samples = static_cast<std::uint64_t>(problem.samples_per_harmonic) * count;
  Eigen::SparseMatrix<double> functions;
  if (count > 1 && samples > 0 && samples < c.count) {
    // A vertex that k functions reach contributes to k^2 products of functions, so the work bounds the square.
    const double max_values =
        std::min((kFunctionsMemory * c.count + spare.memory) / kFunctionMemory,
                 std::sqrt((HarmonicsWork(c.count, count, static_cast<double>(samples)) + spare.work) * c.count));
    if (!RadialFunctions(problem.grid.subspan(c.first, c.count), static_cast<std::uint32_t>(samples), max_values,
                         functions)) {
      return Status::Limit("the harmonic basis takes more work or memory than the limit");
    }
  }
  EigenPairs pairs;
  if (count == 1) {
    pairs = {Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Ones(c.count, 1)};
  } else if (!(functions.cols() > 0 ? ReducedHarmonics(laplacian, mass, functions, count, pairs)
                                    : ExactHarmonics(laplacian, mass, count, pairs))) {
    return Status::Corrupt("harmonics do not converge");
  }
  out.eigenvalues = pairs.values.cwiseMax(0);
  out.vectors = std::move(pairs.vectors);
  Normalize(mass, out);
  return Status::Ok();
}

// The share of `basis` in the generic bilinear form (spec.md 6.6). Constant functions, k = 0, do not enter it.
double GenericForm(const HarmonicBasis& basis) {
  double form = 0;
  for (const ComponentHarmonics& c : basis.components) {
    for (Eigen::Index k = 1; k < c.vectors.cols(); ++k) {
      double column = 0;
      for (Eigen::Index v = 0; v < c.vectors.rows(); ++v)
        column += Generic(static_cast<std::uint32_t>(7 * v)) * c.vectors(v, k);
      form += Generic(static_cast<std::uint32_t>(3 * k)) * column / static_cast<double>(c.vectors.rows());
    }
  }
  return form;
}

}  // namespace

std::array<float, 2> Fingerprint(const HarmonicBasis& components, const HarmonicBasis& patches) {
  double sum = 0;
  for (const ComponentHarmonics& c : components.components) sum += c.eigenvalues.sum();
  return {static_cast<float>(sum), static_cast<float>(GenericForm(components) + GenericForm(patches))};
}

bool SameFingerprint(const std::array<float, 2>& a, const std::array<float, 2>& b) {
  return std::abs(a[0] - b[0]) <= 1e-5f * std::abs(a[0]) + 1e-6f &&
         std::abs(a[1] - b[1]) <= 1e-5f * std::abs(a[1]) + 1e-5f;
}

namespace {

// The eigenproblem that ComputeComponent solves for a component.
struct Eigenproblem {
  Eigenproblem(double vertices, double harmonics, double samples)
      : reduced(samples > 0 && samples < vertices),
        size(reduced ? samples : vertices),
        basis(std::min(2 * harmonics + kSpareVectors, size)),
        dense(size <= kDenseSize || basis == size) {}
  bool reduced;
  double size;
  double basis;  // number of Lanczos vectors
  bool dense;    // whether a dense solver computes all eigenpairs at once
};

}  // namespace

double HarmonicsWork(double vertices, double harmonics, double samples) {
  if (harmonics == 1) return vertices;
  const Eigenproblem problem(vertices, harmonics, samples);
  const double n = problem.size, basis = problem.basis;
  const double products = problem.reduced ? 10 * vertices * (harmonics * harmonics + samples) : 0;
  if (problem.dense) return products + 10 * n * n * n;
  return products + kUsualRestarts * basis * n * (problem.reduced ? basis + n : basis);
}

double HarmonicsMemory(double vertices, double harmonics, double samples) {
  constexpr double kValue = sizeof(double);
  if (harmonics == 1) return kValue * vertices;
  const Eigenproblem problem(vertices, harmonics, samples);
  const double n = problem.size, kept = kValue * vertices * harmonics;
  const double vectors = kValue * (n <= kDenseSize ? 4 * n * n : n * problem.basis);
  return problem.reduced ? 4 * kept + kFunctionsMemory * vertices + vectors + 6 * kValue * n * n : 2 * kept + vectors;
}

Status ComputeHarmonics(const LaplaceProblem& problem, const Spare& spare, HarmonicBasis& basis) {
  basis.components.clear();
  basis.order = HarmonicOrder(problem.counts);
  for (std::size_t i = 0; i < problem.components.size(); ++i) {
    ComponentHarmonics& c = basis.components.emplace_back();
    c.component = problem.components[i];
    const Status status = ComputeComponent(problem, problem.counts[i], spare, c);
    if (!status.ok()) return {status.code(), "component " + std::to_string(i) + ": " + status.message()};
  }
  return Status::Ok();
}

}  // namespace sac

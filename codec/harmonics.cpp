#include "codec/harmonics.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <Spectra/SymEigsShiftSolver.h>

#include <algorithm>
#include <cmath>
#include <limits>


namespace sac {
namespace {

constexpr double kInhomogeneity = 0.1;
constexpr std::uint32_t kDenseSize = 96;  // up to here all eigenpairs at once are as quick as the wanted ones

// A fixed generic cubic of the coordinates scaled to [0, 1], within [-1, 1] (spec.md 6.4.2).
double GenericCubic(const Eigen::Vector3d& p) {
  const double x = p[0], y = p[1], z = p[2];
  return 0.31 * x - 0.23 * y + 0.17 * z + 0.19 * x * y - 0.29 * y * z + 0.13 * z * x + 0.11 * x * x * y - 0.07 * y * y * z +
         0.05 * z * z * x + 0.21 * x * x - 0.15 * z * z + 0.09 * y * y * y;
}

// A fixed generic number in [-1, 1) for each index (spec.md 6.4.3).
double Generic(std::uint32_t i) { return static_cast<double>((i + 1) * 2654435761u) / 2147483648.0 - 1.0; }

// (A - sigma B)^-1 for symmetric A and B = diag(b), as Spectra's operation on D^-1/2 A D^-1/2.
class ShiftSolve {
 public:
  using Scalar = double;
  ShiftSolve(const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& masses)
      : matrix_(lower), masses_(masses), root_(masses.cwiseSqrt()) {}
  Eigen::Index rows() const { return matrix_.rows(); }
  Eigen::Index cols() const { return matrix_.cols(); }
  void set_shift(double sigma) {
    Eigen::SparseMatrix<double> shifted = matrix_;
    for (Eigen::Index i = 0; i < rows(); ++i) shifted.coeffRef(i, i) -= sigma * masses_[i];
    solver_.compute(shifted);
  }
  void perform_op(const double* in, double* out) const {
    const Eigen::Map<const Eigen::VectorXd> x(in, rows());
    Eigen::Map<Eigen::VectorXd> y(out, rows());
    y = root_.cwiseProduct(solver_.solve(root_.cwiseProduct(x)));
  }
  bool ok() const { return solver_.info() == Eigen::Success; }

 private:
  const Eigen::SparseMatrix<double>& matrix_;
  const Eigen::VectorXd& masses_;
  Eigen::VectorXd root_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver_;
};

struct EigenPairs {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // of A v = lambda B v, B-orthonormal
};

// The `count` smallest eigenpairs of (A, diag(masses)) with A sparse, positive semidefinite, given by its lower triangle.
bool SmallestEigenpairs(const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& masses, std::uint32_t count,
                        EigenPairs& out) {
  const Eigen::VectorXd scale = masses.cwiseSqrt().cwiseInverse();
  const auto n = static_cast<std::uint32_t>(masses.size());
  if (n <= kDenseSize || 3 * static_cast<std::uint64_t>(count) > n) {
    const Eigen::MatrixXd full = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * full * scale.asDiagonal());
    if (solver.info() != Eigen::Success) return false;
    out.values = solver.eigenvalues().head(count);
    out.vectors = scale.asDiagonal() * solver.eigenvectors().leftCols(count);
    return true;
  }
  // The shift is a small part of the eigenvalues' spacing (Weyl's law for a surface), so that the constant function
  // does not drown the others.
  const double shift = -1.0 / masses.sum();
  ShiftSolve operation(lower, masses);
  const auto wanted = static_cast<Eigen::Index>(count);
  Spectra::SymEigsShiftSolver<ShiftSolve> solver(operation, wanted, std::min<Eigen::Index>(2 * wanted + 20, n), shift);
  if (!operation.ok()) return false;
  Eigen::VectorXd start(n);
  for (std::uint32_t i = 0; i < n; ++i) start[i] = Generic(i);
  solver.init(start.data());
  solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-13, Spectra::SortRule::SmallestAlge);
  if (solver.info() != Spectra::CompInfo::Successful) return false;
  out.values = solver.eigenvalues();
  out.vectors = scale.asDiagonal() * solver.eigenvectors();
  return true;
}

bool ComputeComponent(const EdgeList& edges, std::span<const double> weights, const Eigen::VectorXd& masses,
                      std::span<const std::array<std::uint32_t, 3>> grid, std::uint32_t count,
                      std::uint32_t samples_per_harmonic, ComponentHarmonics& out) {
  const Component& c = out.component;
  // spec.md 6.4.2: weights are stretched unevenly, which splits the multiple eigenvalues of symmetric shapes.
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::max()), high = -low;
  const auto point = [&](std::uint32_t v) { return Eigen::Array3d(grid[v][0], grid[v][1], grid[v][2]); };
  for (std::uint32_t v = c.first; v < c.first + c.count; ++v) {
    low = low.min(point(v));
    high = high.max(point(v));
  }
  const double extent = std::max(1.0, (high - low).maxCoeff());
  std::vector<double> uneven(weights.begin(), weights.end());
  const auto begin = std::lower_bound(edges.ends.begin(), edges.ends.end(), std::array<std::uint32_t, 2>{c.first, 0});
  for (auto e = begin; e != edges.ends.end() && (*e)[0] < c.first + c.count; ++e) {
    const Eigen::Vector3d middle = ((point((*e)[0]) + point((*e)[1])) / 2 - low) / extent;
    uneven[static_cast<std::size_t>(e - edges.ends.begin())] *= 1 + kInhomogeneity * GenericCubic(middle);
  }
  const Eigen::SparseMatrix<double> laplacian = LaplacianMatrix(edges, uneven, c.first, c.count);
  const Eigen::VectorXd mass = masses.segment(c.first, c.count);
  (void)samples_per_harmonic;
  EigenPairs pairs;
  if (!SmallestEigenpairs(laplacian, mass, count, pairs)) return false;
  out.eigenvalues = pairs.values.cwiseMax(0);
  out.vectors = pairs.vectors;
  // The constant function is known exactly.
  out.eigenvalues[0] = 0;
  out.vectors.col(0).setOnes();
  for (std::uint32_t k = 0; k < count; ++k) {
    auto h = out.vectors.col(k);
    double sign = 0;
    for (std::uint32_t v = 0; v < c.count; ++v) sign += Generic(v) * h[v];
    const double mean_square = h.cwiseAbs2().dot(mass) / mass.sum();
    h *= (k > 0 && sign < 0 ? -1.0 : 1.0) / std::sqrt(mean_square);
  }
  return true;
}

}  // namespace

std::array<float, 2> HarmonicBasis::Fingerprint() const {
  double sum = 0, form = 0;
  for (const ComponentHarmonics& c : components) {
    sum += c.eigenvalues.sum();
    for (Eigen::Index k = 0; k < c.vectors.cols(); ++k) {
      double column = 0;
      for (Eigen::Index v = 0; v < c.vectors.rows(); ++v) column += Generic(static_cast<std::uint32_t>(7 * v)) * c.vectors(v, k);
      form += Generic(static_cast<std::uint32_t>(3 * k)) * column / static_cast<double>(c.vectors.rows());
    }
  }
  return {static_cast<float>(sum), static_cast<float>(form)};
}

bool SameFingerprint(const std::array<float, 2>& a, const std::array<float, 2>& b) {
  return std::abs(a[0] - b[0]) <= 1e-5f * std::abs(a[0]) + 1e-6f && std::abs(a[1] - b[1]) <= 1e-5f;
}

Status ComputeHarmonics(const EdgeList& edges, std::span<const double> weights, const Eigen::VectorXd& masses,
                        std::span<const std::array<std::uint32_t, 3>> grid, std::span<const Component> components,
                        std::span<const std::uint32_t> counts, std::uint32_t samples_per_harmonic,
                        HarmonicBasis& basis) {
  basis.components.clear();
  for (std::size_t i = 0; i < components.size(); ++i) {
    ComponentHarmonics& c = basis.components.emplace_back();
    c.component = components[i];
    if (!ComputeComponent(edges, weights, masses, grid, counts[i], samples_per_harmonic, c)) {
      return Status::Corrupt("the harmonics of component " + std::to_string(i) + " do not converge");
    }
  }
  return Status::Ok();
}

}  // namespace sac

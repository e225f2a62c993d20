// SPDX-License-Identifier: Apache-2.0
#include "codec/harmonics.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "codec/eigenpairs.h"
#include "geometry/laplacian.h"
#include "geometry/sparse_cholesky.h"

namespace sac {
namespace {

constexpr double kInhomogeneity = 0.1;
constexpr double kVertexWork = 6000, kVertexMemory = 350;  // of the blend's matrices on a surface, a vertex
constexpr double kHandleMemory = 25'000;                   // of the same, a handle

// A fixed generic cubic polynomial of coordinates scaled to [0, 1], with values in [-1, 1] (spec.md 6.4.2).
double GenericCubic(const Eigen::Array3d& p) {
  const double x = p[0], y = p[1], z = p[2];
  return 0.31 * x - 0.23 * y + 0.17 * z + 0.19 * x * y - 0.29 * y * z + 0.13 * z * x + 0.11 * x * x * y -
         0.07 * y * y * z + 0.05 * z * z * x + 0.21 * x * x - 0.15 * z * z + 0.09 * y * y * y;
}

// The generic numbers of the vertices of a component, those of `factor` times the vertex, which counts from 0.
Eigen::VectorXd GenericOfVertices(std::uint32_t count, std::uint32_t factor) {
  Eigen::VectorXd numbers(count);
  for (std::uint32_t v = 0; v < count; ++v) numbers[v] = Generic(factor * v);
  return numbers;
}

// Computes the smallest eigenpairs of L h = lambda D h, L given by its lower triangle. With h = D^-1/2 y they are those
// of D^-1/2 L D^-1/2.
bool ExactHarmonics(const Eigen::SparseMatrix<double>& laplacian, const Eigen::VectorXd& mass, std::uint32_t count,
                    EigenPairs& out) {
  const Eigen::VectorXd scale = mass.cwiseSqrt().cwiseInverse();
  Eigen::SparseMatrix<double> scaled;
  scaled = scale.asDiagonal() * laplacian * scale.asDiagonal();
  if (!SmallestEigenpairs(scaled, count, out)) return false;
  out.vectors = scale.asDiagonal() * out.vectors;
  return true;
}

// Replaces the columns of `image` by the `count` Ritz vectors with the smallest eigenvalues in the span of
// Y = (S + G)^-1 G Z, Z those columns: a step of inverse iteration. `solver` has the factors of S + G, `gram` is G.
bool Iterate(const SparseCholesky& solver, const Eigen::SparseMatrix<double>& gram, std::uint32_t count,
             RowMatrix& image, Eigen::VectorXd& values) {
  const RowMatrix weighted = gram * image;
  image = weighted;
  solver.SolveInPlace(image);
  // With (S + G) Y = G Z, Y^T S Y = Y^T G Z - Y^T G Y: symmetric, so their lower triangles are enough.
  Eigen::MatrixXd stiffness(image.cols(), image.cols()), mass(image.cols(), image.cols());
  stiffness.triangularView<Eigen::Lower>() = image.transpose() * weighted;
  const RowMatrix weighted_image = gram * image;
  mass.triangularView<Eigen::Lower>() = image.transpose() * weighted_image;
  stiffness.triangularView<Eigen::Lower>() -= mass;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(stiffness, mass);
  if (ritz.info() != Eigen::Success) return false;
  // Swapped in, because Eigen's assignment to a matrix of another size would free it twice when there is too little
  // memory.
  Eigen::VectorXd smallest = ritz.eigenvalues().head(count);
  RowMatrix vectors = image * ritz.eigenvectors().leftCols(count);
  values.swap(smallest);
  image.swap(vectors);
  return true;
}

// Computes the harmonics of a blend. It begins with functions that are 1 around each leader; the steps make them smooth
// and bring in the functions that turn and stretch. `leaders` are those of the component's handles.
bool BlendHarmonics(const Eigen::SparseMatrix<double>& stiffness, const Eigen::SparseMatrix<double>& gram,
                    std::span<const std::uint32_t> leaders, std::uint32_t count, EigenPairs& out) {
  const std::uint32_t first = leaders.front();
  RowMatrix image = RowMatrix::Zero(gram.rows(), LeaderCount(static_cast<std::uint32_t>(leaders.size()), count));
  for (std::size_t h = 0; h < leaders.size(); ++h) image(4 * static_cast<Eigen::Index>(h) + 3, leaders[h] - first) = 1;
  Eigen::SparseMatrix<double> shifted;
  shifted = stiffness + gram;
  SparseCholesky solver;
  if (!solver.Analyze(shifted) || !solver.Factorize(shifted)) return false;
  Eigen::SparseMatrix<double> whole;
  whole = gram.selfadjointView<Eigen::Lower>();
  for (int step = 0; step < 2; ++step) {
    if (!Iterate(solver, whole, count, image, out.values)) return false;
  }
  Eigen::MatrixXd vectors = image;
  out.vectors.swap(vectors);
  return true;
}

// Scales each harmonic to a mean square of 1 and gives it the sign of spec.md 6.4.3. `constant` has the coefficients of
// the constant 1, which the first harmonic is set to, and `signs` of each function the sum over vertices v of G(v)
// times its value. `squares` has the mean square of each harmonic but the first.
void Normalize(const Eigen::VectorXd& constant, const Eigen::VectorXd& signs, const Eigen::VectorXd& squares,
               ComponentHarmonics& harmonics) {
  harmonics.eigenvalues = harmonics.eigenvalues.cwiseMax(0);
  harmonics.eigenvalues[0] = 0;
  harmonics.vectors.col(0) = constant;
  for (Eigen::Index k = 1; k < harmonics.vectors.cols(); ++k) {
    auto h = harmonics.vectors.col(k);
    h *= (signs.dot(h) < 0 ? -1.0 : 1.0) / std::sqrt(squares[k]);
  }
}

// The harmonics of a component whose functions are its vertices' own.
bool HarmonicsOfVertices(const Eigen::SparseMatrix<double>& laplacian, const Eigen::VectorXd& mass, std::uint32_t count,
                         ComponentHarmonics& out) {
  EigenPairs pairs = {Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Ones(mass.size(), 1)};
  if (count > 1 && !ExactHarmonics(laplacian, mass, count, pairs)) return false;
  const Eigen::VectorXd squares = (pairs.vectors.cwiseAbs2().transpose() * mass / mass.sum()).eval();
  out.eigenvalues = std::move(pairs.values);
  out.vectors = std::move(pairs.vectors);
  const auto vertices = static_cast<std::uint32_t>(mass.size());
  Normalize(Eigen::VectorXd::Ones(mass.size()), GenericOfVertices(vertices, 1), squares, out);
  out.generic = GenericOfVertices(vertices, 7);
  return true;
}

Status DoNotConverge(std::size_t component) {
  return Status::Corrupt("component " + std::to_string(component) + ": harmonics do not converge");
}

// The share of `basis` in the generic bilinear form (spec.md 6.6). Constant functions, k = 0, do not enter it.
double GenericForm(const HarmonicBasis& basis) {
  double form = 0;
  for (const ComponentHarmonics& c : basis.components) {
    for (Eigen::Index k = 1; k < c.vectors.cols(); ++k) {
      form += Generic(static_cast<std::uint32_t>(3 * k)) * c.generic.dot(c.vectors.col(k)) / c.component.count;
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

std::vector<double> Unevenness(const EdgeList& edges, std::span<const GridPosition> grid,
                               std::span<const Component> runs) {
  std::vector<double> uneven(edges.ends.size(), 1.0);
  const auto point = [&](std::uint32_t v) { return Eigen::Array3d(grid[v][0], grid[v][1], grid[v][2]); };
  for (const Component& c : runs) {
    Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::max()), high = -low;
    for (std::uint32_t v = c.first; v < c.first + c.count; ++v) {
      low = low.min(point(v));
      high = high.max(point(v));
    }
    const double extent = std::max(1.0, (high - low).maxCoeff());
    const EdgeRange range = EdgesOf(edges, c.first, c.count);
    for (std::size_t e = range.begin; e < range.begin + range.count; ++e) {
      if (edges.ends[e][1] >= c.first + c.count) continue;
      const Eigen::Array3d middle = (point(edges.ends[e][0]) + point(edges.ends[e][1])) / 2;
      uneven[e] = 1 + kInhomogeneity * GenericCubic((middle - low) / extent);
    }
  }
  return uneven;
}

double HarmonicsWork(double vertices, double harmonics, double handles) {
  if (handles == vertices) return harmonics == 1 ? vertices : EigenpairsWork(vertices, harmonics);
  const double leaders = 4 * harmonics / 3;
  return kVertexWork * vertices + 4 * handles * leaders * (6 * leaders + handles) + 15 * leaders * leaders * leaders;
}

double HarmonicsMemory(double vertices, double harmonics, double handles) {
  constexpr double kValue = sizeof(double);
  if (handles == vertices) {
    const double kept = kValue * vertices * harmonics;
    return harmonics == 1 ? kept : 2 * kept + EigenpairsMemory(vertices, harmonics);
  }
  return kVertexMemory * vertices + kHandleMemory * handles + kValue * harmonics * (25 * handles + 10 * harmonics);
}

Status ComputeHarmonics(const LaplaceProblem& problem, HarmonicBasis& basis) {
  basis.components.clear();
  basis.order = HarmonicOrder(problem.counts);
  for (std::size_t i = 0; i < problem.components.size(); ++i) {
    const Component& c = problem.components[i];
    ComponentHarmonics& out = basis.components.emplace_back();
    out.component = out.functions = c;
    const EdgeRange range = EdgesOf(problem.edges, c.first, c.count);
    const Eigen::SparseMatrix<double> laplacian =
        LaplacianMatrix(std::span(problem.edges.ends).subspan(range.begin, range.count),
                        problem.weights.subspan(range.begin, range.count), c.first, c.count);
    if (!HarmonicsOfVertices(laplacian, problem.masses.segment(c.first, c.count), problem.counts[i], out)) {
      return DoNotConverge(i);
    }
  }
  return Status::Ok();
}

Status ComputeBlendHarmonics(const Blend& blend, const BlendSystem& system, const EdgeGraph& graph,
                             std::span<const Component> components, const Eigen::VectorXd& masses,
                             std::span<const std::uint32_t> counts, HarmonicBasis& basis) {
  basis.components.clear();
  basis.order = HarmonicOrder(counts);
  Eigen::MatrixXd generic(masses.size(), 2);
  for (const Component& c : components) {
    generic.block(c.first, 0, c.count, 1) = GenericOfVertices(c.count, 1);
    generic.block(c.first, 1, c.count, 1) = GenericOfVertices(c.count, 7);
  }
  generic = blend.TransposeTimes(generic);
  for (std::size_t i = 0; i < components.size(); ++i) {
    const Component &c = components[i], &functions = blend.functions()[i];
    ComponentHarmonics& out = basis.components.emplace_back();
    out.component = c;
    out.functions = functions;
    const Eigen::VectorXd mass = masses.segment(c.first, c.count);
    if (!blend.IsAffine(i)) {
      const Eigen::SparseMatrix<double> laplacian = counts[i] > 1 ? system.Stiffness(i) : Eigen::SparseMatrix<double>();
      if (!HarmonicsOfVertices(laplacian, mass, counts[i], out)) return DoNotConverge(i);
      continue;
    }
    EigenPairs pairs = {Eigen::VectorXd::Zero(1), Eigen::MatrixXd(functions.count, 1)};
    Eigen::VectorXd squares;
    if (counts[i] > 1) {
      const Eigen::SparseMatrix<double> gram = blend.Congruence(i, graph, {masses, {}});
      const Component& run = blend.handles().components[i];
      const auto leaders = std::span(blend.handles().leaders).subspan(run.first, run.count);
      if (!BlendHarmonics(system.Stiffness(i), gram, leaders, counts[i], pairs)) return DoNotConverge(i);
      const Eigen::MatrixXd weighted = gram.selfadjointView<Eigen::Lower>() * pairs.vectors;
      squares = pairs.vectors.cwiseProduct(weighted).colwise().sum().transpose() / mass.sum();
    }
    out.eigenvalues = std::move(pairs.values);
    out.vectors = std::move(pairs.vectors);
    Eigen::VectorXd constant = Eigen::VectorXd::Zero(functions.count);
    for (Eigen::Index t = 3; t < constant.size(); t += 4) constant[t] = 1;
    Normalize(constant, generic.block(functions.first, 0, functions.count, 1), squares, out);
    out.generic = generic.block(functions.first, 1, functions.count, 1);
  }
  return Status::Ok();
}

}  // namespace sac

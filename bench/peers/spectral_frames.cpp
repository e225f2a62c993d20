// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/spectral_frames.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "codec/harmonics.h"

namespace sac::bench {

std::vector<std::uint32_t> SpectralBasis::ComponentOrder(std::span<const Triangle> triangles, std::size_t vertices) {
  std::uint32_t components = 0;
  const auto label = LabelComponents(static_cast<std::uint32_t>(vertices), triangles, components);
  std::vector<std::uint32_t> order(vertices);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return label[a] < label[b]; });
  return order;
}

Status SpectralBasis::Build(std::vector<Triangle> triangles, const PositionMatrix& first_frame, std::uint32_t bases) {
  triangles_ = std::move(triangles);
  const auto n = static_cast<std::uint32_t>(first_frame.rows());
  std::uint32_t count = 0;
  const auto label = LabelComponents(n, triangles_, count);
  components_.assign(count, {n, 0});
  for (std::uint32_t v = 0; v < n; ++v) {
    components_[label[v]].first = std::min(components_[label[v]].first, v);
    ++components_[label[v]].count;
  }
  std::vector<std::uint32_t> counts;
  for (const Component& c : components_) {
    const double share = static_cast<double>(bases) * c.count / n;
    counts.push_back(std::min(c.count, std::max(1u, static_cast<std::uint32_t>(share))));
  }
  const EdgeList edges = BuildEdges(triangles_);
  HarmonicBasis harmonics;
  const std::vector<double> weights = CotangentWeights(first_frame, triangles_, edges);
  const Eigen::VectorXd masses = VertexMasses(first_frame, triangles_);
  SAC_RETURN_IF_ERROR(ComputeHarmonics({edges, weights, masses, components_, counts}, harmonics));
  const auto columns = static_cast<Eigen::Index>(std::accumulate(counts.begin(), counts.end(), 0u));
  Eigen::MatrixXd at_vertices = Eigen::MatrixXd::Zero(n, columns);
  Eigen::Index column = 0;
  for (std::size_t i = 0; i < components_.size(); ++i) {
    at_vertices.block(components_[i].first, column, components_[i].count, counts[i]) = harmonics.components[i].vectors;
    column += counts[i];
  }
  at_triangles_.resize(static_cast<Eigen::Index>(triangles_.size()), columns);
  for (std::size_t j = 0; j < triangles_.size(); ++j) {
    const Triangle& t = triangles_[j];
    at_triangles_.row(static_cast<Eigen::Index>(j)) =
        (at_vertices.row(t[0]) + at_vertices.row(t[1]) + at_vertices.row(t[2])) / 3;
  }
  Eigen::MatrixXd normal = at_triangles_.transpose() * at_triangles_;
  normal.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff();  // components with few triangles
  normal_.compute(normal);
  return Status::Ok();
}

Status SolveGradients(const SpectralBasis& basis, const PositionMatrix& reference,
                      const std::vector<Eigen::Matrix3d>& gradients, const PositionMatrix& centres,
                      PositionMatrix& out) {
  // The Dirichlet energy of a triangle is half the sum, over its edges e, of the cotangent opposite the edge times the
  // squared distance of the deformed edge from J e.
  std::vector<Eigen::Triplet<double>> entries;
  PositionMatrix right = PositionMatrix::Zero(reference.rows(), 3);
  for (std::size_t j = 0; j < basis.triangles().size(); ++j) {
    const Triangle& t = basis.triangles()[j];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      const Eigen::Vector3d u = reference.row(a) - reference.row(t[k]), v = reference.row(b) - reference.row(t[k]);
      // Angles below half a degree count as half a degree, so that slivers do not outweigh all other triangles.
      const double area2 = std::max(u.cross(v).norm(), 0.01 * u.norm() * v.norm());
      if (!(area2 > 0)) continue;
      const double weight = u.dot(v) / area2 / 2;
      entries.emplace_back(a, a, weight);
      entries.emplace_back(b, b, weight);
      entries.emplace_back(std::max(a, b), std::min(a, b), -weight);
      const Eigen::Vector3d pull = weight * (gradients[j] * (u - v));
      right.row(a) += pull;
      right.row(b) -= pull;
    }
  }
  for (const Component& c : basis.components()) entries.emplace_back(c.first, c.first, 1.0);
  Eigen::SparseMatrix<double> matrix(reference.rows(), reference.rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver(matrix);
  if (solver.info() != Eigen::Success) return Status::Unsupported("the Poisson system cannot be factorized");
  out = solver.solve(right);
  const PositionMatrix now = Centres(basis, out);
  for (std::size_t i = 0; i < basis.components().size(); ++i) {
    const Component& c = basis.components()[i];
    out.middleRows(c.first, c.count).rowwise() +=
        centres.row(static_cast<Eigen::Index>(i)) - now.row(static_cast<Eigen::Index>(i));
  }
  return Status::Ok();
}

PositionMatrix Centres(const SpectralBasis& basis, const PositionMatrix& positions) {
  PositionMatrix centres(static_cast<Eigen::Index>(basis.components().size()), 3);
  for (std::size_t i = 0; i < basis.components().size(); ++i) {
    const Component& c = basis.components()[i];
    centres.row(static_cast<Eigen::Index>(i)) = positions.middleRows(c.first, c.count).colwise().mean();
  }
  return centres;
}

}  // namespace sac::bench

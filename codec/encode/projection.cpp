// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/projection.h"

#include "geometry/triangle_fields.h"

namespace sac {
namespace {

// The relative weight that is added to the diagonal of a normal matrix, which is singular when a component has no area
// or fewer triangles than harmonics.
constexpr double kRidge = 1e-9;

Eigen::LDLT<Eigen::MatrixXd> Factor(Eigen::MatrixXd gram) {
  gram.diagonal().array() += kRidge * gram.diagonal().maxCoeff() + 1e-300;
  return Eigen::LDLT<Eigen::MatrixXd>(gram);
}

// The rows of all components' coefficients in the order of a plane's rows.
Eigen::MatrixXd InOrder(const HarmonicBasis& basis, const std::vector<Eigen::MatrixXd>& coefficients) {
  const Eigen::Index channels = coefficients.empty() ? 0 : coefficients[0].cols();
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(basis.order.size()), channels);
  for (std::size_t i = 0; i < basis.order.size(); ++i) {
    const HarmonicIndex& index = basis.order[i];
    rows.row(static_cast<Eigen::Index>(i)) = coefficients[index.component].row(index.k);
  }
  return rows;
}

// The matrix Z^T Psi^T M Psi Z of a component's harmonics.
Eigen::MatrixXd Gram(const Shape& shape, std::size_t c, const VertexMatrix& m) {
  const Eigen::MatrixXd& z = shape.basis.components[c].vectors;
  const Eigen::SparseMatrix<double> functions = shape.blend.Congruence(c, shape.graph, m);
  return z.transpose() * (functions.selfadjointView<Eigen::Lower>() * z);
}

}  // namespace

Projection::Projection(const Shape& shape, const Eigen::VectorXd& areas)
    : shape_(shape), areas_(areas.sum() > 0 ? (areas / areas.sum()).eval() : areas) {
  // A triangle's value is the mean of those of its corners, so its area counts a ninth for each pair of corners.
  Eigen::VectorXd at_vertices = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(shape.vertices()));
  std::vector<double> at_edges(shape.edges.ends.size(), 0.0);
  for (std::size_t j = 0; j < shape.triangles.size(); ++j) {
    const double share = areas_[static_cast<Eigen::Index>(j)] / 9;
    for (std::size_t k = 0; k < 3; ++k) {
      at_vertices[shape.triangles[j][k]] += share;
      const std::uint32_t e = shape.edges.of_triangle[j][k];
      if (e != EdgeList::kNone) at_edges[e] += share;
    }
  }
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(at_vertices.size());
  for (std::size_t c = 0; c < shape.components.size(); ++c) {
    systems_.push_back({Factor(Gram(shape, c, {at_vertices, at_edges})), Factor(Gram(shape, c, {ones, {}}))});
  }
}

Eigen::MatrixXd Projection::Solve(const Eigen::MatrixXd& at_vertices,
                                  Eigen::LDLT<Eigen::MatrixXd> Systems::*system) const {
  const Eigen::MatrixXd of_functions = shape_.blend.TransposeTimes(at_vertices);
  std::vector<Eigen::MatrixXd> solutions;
  for (std::size_t i = 0; i < systems_.size(); ++i) {
    const ComponentHarmonics& c = shape_.basis.components[i];
    solutions.push_back(
        (systems_[i].*system)
            .solve(c.vectors.transpose() * of_functions.middleRows(c.functions.first, c.functions.count)));
  }
  return InOrder(shape_.basis, solutions);
}

Eigen::MatrixXd Projection::ProjectTriangles(const Eigen::MatrixXd& fields) const {
  Eigen::MatrixXd at_vertices = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(shape_.vertices()), fields.cols());
  for (Eigen::Index channel = 0; channel < fields.cols(); ++channel) {
    for (std::size_t j = 0; j < shape_.triangles.size(); ++j) {
      const auto row = static_cast<Eigen::Index>(j);
      const double share = fields(row, channel) * areas_[row] / 3;
      for (const std::uint32_t v : shape_.triangles[j]) at_vertices(v, channel) += share;
    }
  }
  return Solve(at_vertices, &Systems::triangles);
}

Eigen::MatrixXd Projection::ProjectVertices(const Eigen::MatrixXd& field) const {
  return Solve(field, &Systems::vertices);
}

Eigen::MatrixXd Projection::ProjectPatches(const Eigen::MatrixXd& field) const {
  std::vector<Eigen::MatrixXd> coefficients;
  for (const ComponentHarmonics& c : shape_.patch_basis.components) {
    // Patch harmonics are orthogonal with a mean square of 1, so that no system has to be solved.
    coefficients.push_back(c.vectors.transpose() * field.middleRows(c.component.first, c.component.count) /
                           c.component.count);
  }
  return InOrder(shape_.patch_basis, coefficients);
}

std::unique_ptr<const Projection> ProjectionOf(const Shape& shape) {
  TriangleFields fields(shape.triangles);
  fields.Measure(shape.positions, shape.positions);
  return std::make_unique<const Projection>(shape, fields.areas());
}

}  // namespace sac

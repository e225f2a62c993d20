// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/projection.h"

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

}  // namespace

Projection::Projection(const Shape& shape, const Eigen::VectorXd& areas)
    : shape_(shape), areas_(areas.sum() > 0 ? (areas / areas.sum()).eval() : areas) {
  std::vector<std::vector<std::size_t>> triangles(shape.components.size());
  std::vector<std::uint32_t> component(shape.vertices());
  for (std::size_t i = 0; i < shape.components.size(); ++i) {
    const Component& c = shape.components[i];
    std::fill_n(component.begin() + c.first, c.count, static_cast<std::uint32_t>(i));
  }
  for (std::size_t j = 0; j < shape.triangles.size(); ++j) triangles[component[shape.triangles[j][0]]].push_back(j);

  for (std::size_t i = 0; i < shape.components.size(); ++i) {
    const ComponentHarmonics& c = shape.basis.components[i];
    Eigen::MatrixXd means(static_cast<Eigen::Index>(triangles[i].size()), c.vectors.cols());
    for (std::size_t r = 0; r < triangles[i].size(); ++r) {
      const std::size_t j = triangles[i][r];
      const Triangle& t = shape.triangles[j];
      const std::uint32_t first = c.component.first;
      means.row(static_cast<Eigen::Index>(r)) =
          (c.vectors.row(t[0] - first) + c.vectors.row(t[1] - first) + c.vectors.row(t[2] - first)) *
          (std::sqrt(areas_[static_cast<Eigen::Index>(j)]) / 3);
    }
    systems_.push_back({Factor(means.transpose() * means), Factor(c.vectors.transpose() * c.vectors)});
  }
}

Eigen::MatrixXd Projection::Solve(const Eigen::MatrixXd& at_vertices,
                                  Eigen::LDLT<Eigen::MatrixXd> Systems::*system) const {
  std::vector<Eigen::MatrixXd> solutions;
  for (std::size_t i = 0; i < systems_.size(); ++i) {
    const ComponentHarmonics& c = shape_.basis.components[i];
    solutions.push_back(
        (systems_[i].*system)
            .solve(c.vectors.transpose() * at_vertices.middleRows(c.component.first, c.component.count)));
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

}  // namespace sac

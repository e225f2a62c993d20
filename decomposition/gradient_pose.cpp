// SPDX-License-Identifier: Apache-2.0
#include "decomposition/gradient_pose.h"

#include <cmath>
#include <cstddef>

#include "geometry/deformation.h"

namespace sac {
namespace {

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v[2], v[1],  //
      v[2], 0, -v[0],   //
      -v[1], v[0], 0;
  return m;
}

// The matrix that takes a change of the rotation vector `u` to the rotation by which exp(u) changes from the left.
Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& u) {
  const double square = u.squaredNorm(), angle = std::sqrt(square);
  const double a = angle > 1e-4 ? (1 - std::cos(angle)) / square : 0.5 - square / 24;
  const double b = angle > 1e-4 ? (angle - std::sin(angle)) / (square * angle) : 1.0 / 6 - square / 120;
  const Eigen::Matrix3d cross = CrossMatrix(u);
  return Eigen::Matrix3d::Identity() + a * cross + b * cross * cross;
}

Eigen::Matrix3d SymmetricMatrix(const double (&c)[9]) {
  Eigen::Matrix3d m;
  m << c[3], c[6], c[7],  //
      c[6], c[4], c[8],   //
      c[7], c[8], c[5];
  return m;
}

// What the derivatives of one triangle's gradient J = exp(u) (I + p) are made of.
struct TriangleTangent {
  explicit TriangleTangent(const Eigen::VectorXd& q) {
    const Eigen::Vector3d u = q.head<3>();
    double channels[9];
    for (int a = 0; a < 9; ++a) channels[a] = q[a];
    rotation = RotationOf(u);
    gradient = DeformationGradient(channels);
    jacobian = LeftJacobian(u);
  }
  Eigen::Matrix3d Derivative(const float* value) const {
    double c[9];
    for (int a = 0; a < 9; ++a) c[a] = static_cast<double>(value[a]);
    return CrossMatrix(jacobian * Eigen::Vector3d(c[0], c[1], c[2])) * gradient + rotation * SymmetricMatrix(c);
  }
  Eigen::Matrix3d rotation, gradient, jacobian;
};

}  // namespace

Status GradientPose::Prepare(const SparseComponents& components, const PositionMatrix& rest) {
  components_ = &components;
  return poisson_.Prepare(rest, components.triangles, components.still);
}

Eigen::MatrixXd GradientPose::Channels(const Eigen::VectorXd& weights) const {
  using Channels = Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor>;
  Channels q = Channels::Zero(static_cast<Eigen::Index>(components_->triangles.size()), 9);
  for (std::size_t k = 0; k < components_->components.size(); ++k) {
    const double w = weights[static_cast<Eigen::Index>(k)];
    if (w == 0) continue;
    const SparseComponent& component = components_->components[k];
    for (std::size_t i = 0; i < component.nodes.size(); ++i) {
      const Eigen::Map<const Eigen::Matrix<float, 1, 9>> value(component.values.data() + 9 * i);
      q.row(component.nodes[i]) += w * value.cast<double>();
    }
  }
  return q;
}

PositionMatrix GradientPose::Shape(const Eigen::VectorXd& weights) const {
  return poisson_.Reconstruct(Channels(weights));
}

RowMatrix GradientPose::Derivatives(const Eigen::VectorXd& weights) const {
  const Eigen::MatrixXd q = Channels(weights);
  std::vector<TriangleTangent> tangents;
  tangents.reserve(components_->triangles.size());
  for (Eigen::Index j = 0; j < q.rows(); ++j) tangents.emplace_back(q.row(j));
  RowMatrix b = RowMatrix::Zero(poisson_.vertices(), 3 * weights.size());
  for (std::size_t k = 0; k < components_->components.size(); ++k) {
    const SparseComponent& component = components_->components[k];
    for (std::size_t i = 0; i < component.nodes.size(); ++i) {
      const std::uint32_t j = component.nodes[i];
      poisson_.AddGradient(j, tangents[j].Derivative(component.values.data() + 9 * i), b,
                           static_cast<Eigen::Index>(3 * k));
    }
  }
  poisson_.SolveOffsets(b);
  return b;
}

// The solution's operator S is applied to the right sides of all components; a row of S is the solution of its
// transpose for that vertex alone.
Eigen::MatrixXd GradientPose::DerivativesAt(const Eigen::VectorXd& weights,
                                            std::span<const std::uint32_t> vertices) const {
  const Eigen::MatrixXd q = Channels(weights);
  std::vector<TriangleTangent> tangents;
  tangents.reserve(components_->triangles.size());
  for (Eigen::Index j = 0; j < q.rows(); ++j) tangents.emplace_back(q.row(j));
  const RowMatrix rows = poisson_.SolutionRows(vertices);
  Eigen::MatrixXd derivatives = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(vertices.size()), weights.size());
  for (std::size_t k = 0; k < components_->components.size(); ++k) {
    const SparseComponent& component = components_->components[k];
    for (std::size_t i = 0; i < component.nodes.size(); ++i) {
      const std::uint32_t j = component.nodes[i];
      const Eigen::Matrix3d change = tangents[j].Derivative(component.values.data() + 9 * i);
      for (Eigen::Index d = 0; d < rows.cols(); ++d) {
        derivatives.block<3, 1>(3 * d, static_cast<Eigen::Index>(k)) += change * poisson_.GradientOfRow(j, rows, d);
      }
    }
  }
  return derivatives;
}

}  // namespace sac

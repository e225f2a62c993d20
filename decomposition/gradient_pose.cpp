// SPDX-License-Identifier: Apache-2.0
#include "decomposition/gradient_pose.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

// What the derivatives of one triangle's gradient J = exp(u) (I + p) are made of. `jacobian` takes a change of u to the
// rotation by which exp(u) changes from the left.
struct TriangleTangent {
  explicit TriangleTangent(const double (&q)[9]) {
    const Eigen::Vector3d u(q[0], q[1], q[2]);
    const double square = u.squaredNorm(), angle = std::sqrt(square);
    const double s = angle > 1e-4 ? std::sin(angle) / angle : 1 - square / 6;
    const double c = angle > 1e-4 ? (1 - std::cos(angle)) / square : 0.5 - square / 24;
    const double b = angle > 1e-4 ? (1 - s) / square : 1.0 / 6 - square / 120;
    const Eigen::Matrix3d cross = CrossMatrix(u), outer = u * u.transpose();
    rotation = s * cross + c * outer;
    rotation.diagonal().array() += 1 - c * square;
    jacobian = c * cross + b * outer;
    jacobian.diagonal().array() += s;
    Eigen::Matrix3d stretch;
    stretch << 1 + q[3], q[6], q[7],  //
        q[6], 1 + q[4], q[8],         //
        q[7], q[8], 1 + q[5];
    gradient = rotation * stretch;
  }
  Eigen::Matrix3d rotation, gradient, jacobian;
};

using Channels = Eigen::Matrix<double, 9, 1>;

Channels ValuesOf(const GradientPose::Entry& entry) {
  return Eigen::Map<const Eigen::Matrix<float, 9, 1>>(entry.values).cast<double>();
}

}  // namespace

Status GradientPose::Prepare(const SparseComponents& components, const PositionMatrix& rest) {
  count_ = components.components.size();
  std::vector<std::size_t> next(components.triangles.size() + 1, 0);
  for (const SparseComponent& component : components.components) {
    for (const std::uint32_t j : component.nodes) ++next[j + 1];
  }
  triangle_.clear();
  first_.assign(1, 0);
  for (std::size_t j = 0; j + 1 < next.size(); ++j) {
    if (next[j + 1] > 0) {
      triangle_.push_back(static_cast<std::uint32_t>(j));
      first_.push_back(first_.back() + next[j + 1]);
    }
    next[j + 1] += next[j];
  }
  entries_.resize(first_.back());
  for (std::size_t k = 0; k < count_; ++k) {
    const SparseComponent& component = components.components[k];
    for (std::size_t i = 0; i < component.nodes.size(); ++i) {
      Entry& entry = entries_[next[component.nodes[i]]++];
      entry.component = static_cast<std::uint32_t>(k);
      for (std::size_t a = 0; a < 9; ++a) entry.values[a] = component.values[9 * i + a];
    }
  }
  return poisson_.Prepare(rest, components.triangles, components.still);
}

template <class Take>
void GradientPose::ForEachTriangle(const Eigen::VectorXd& weights, Take&& take) const {
  for (std::size_t i = 0; i < triangle_.size(); ++i) {
    const std::span<const Entry> entries(entries_.data() + first_[i], first_[i + 1] - first_[i]);
    double q[9] = {};
    for (const Entry& entry : entries) {
      const double w = weights[entry.component];
      for (int a = 0; a < 9; ++a) q[a] += w * static_cast<double>(entry.values[a]);
    }
    take(i, q, entries);
  }
}

PositionMatrix GradientPose::Shape(const Eigen::VectorXd& weights) const {
  RowMatrix b = RowMatrix::Zero(poisson_.vertices(), 3);
  ForEachTriangle(weights, [&](std::size_t i, const double(&q)[9], std::span<const Entry>) {
    poisson_.AddGradient(triangle_[i], DeformationGradient(q) - Eigen::Matrix3d::Identity(), b, 0);
  });
  return poisson_.ReconstructOffsets(b);
}

RowMatrix GradientPose::Derivatives(const Eigen::VectorXd& weights) const {
  RowMatrix b = RowMatrix::Zero(poisson_.vertices(), 3 * static_cast<Eigen::Index>(count_));
  ForEachTriangle(weights, [&](std::size_t i, const double(&q)[9], std::span<const Entry> entries) {
    const TriangleTangent tangent(q);
    for (const Entry& entry : entries) {
      const Channels c = ValuesOf(entry);
      Eigen::Matrix3d stretch;
      stretch << c[3], c[6], c[7],  //
          c[6], c[4], c[8],         //
          c[7], c[8], c[5];
      const Eigen::Matrix3d change =
          CrossMatrix(tangent.jacobian * c.head<3>()) * tangent.gradient + tangent.rotation * stretch;
      poisson_.AddGradient(triangle_[i], change, b, 3 * static_cast<Eigen::Index>(entry.component));
    }
  });
  poisson_.SolveOffsets(b);
  return b;
}

// A change of the channels changes J by the cross matrix of jacobian du times J, and by rotation dp. What that adds to
// the sum are products with nine numbers, which are the same for all components of the triangle.
Eigen::VectorXd GradientPose::DerivativesOfSum(const Eigen::VectorXd& weights, RowMatrix y) const {
  poisson_.SolveTransposed(y);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count_));
  ForEachTriangle(weights, [&](std::size_t i, const double(&q)[9], std::span<const Entry> entries) {
    const TriangleTangent tangent(q);
    const Eigen::Matrix3d rows = poisson_.GradientOfRows(triangle_[i], y, 0);
    const Eigen::Matrix3d m = rows * tangent.gradient.transpose(), z = tangent.rotation.transpose() * rows;
    const Eigen::Vector3d axial(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
    Channels h;
    h << tangent.jacobian.transpose() * axial, z(0, 0), z(1, 1), z(2, 2), z(0, 1) + z(1, 0), z(0, 2) + z(2, 0),
        z(1, 2) + z(2, 1);
    for (const Entry& entry : entries) sums[entry.component] += h.dot(ValuesOf(entry));
  });
  return sums;
}

PosedVertices::PosedVertices(const GradientPose& pose, std::span<const std::uint32_t> vertices)
    : pose_(pose), vertices_(static_cast<Eigen::Index>(vertices.size())) {
  const RowMatrix rows = pose.poisson_.SolutionRows(vertices);
  factors_.reserve(pose.triangle_.size() * vertices.size());
  for (const std::uint32_t j : pose.triangle_) {
    for (Eigen::Index d = 0; d < vertices_; ++d) factors_.push_back(pose.poisson_.GradientOfRow(j, rows, d));
  }
}

Eigen::VectorXd PosedVertices::Offsets(const Eigen::VectorXd& weights, Eigen::MatrixXd* derivatives) const {
  Eigen::VectorXd offsets = Eigen::VectorXd::Zero(3 * vertices_);
  if (derivatives != nullptr) *derivatives = Eigen::MatrixXd::Zero(3 * vertices_, weights.size());
  pose_.ForEachTriangle(weights, [&](std::size_t i, const double(&q)[9], std::span<const GradientPose::Entry> entries) {
    const Eigen::Vector3d* factor = factors_.data() + i * static_cast<std::size_t>(vertices_);
    const TriangleTangent tangent(q);
    for (Eigen::Index d = 0; d < vertices_; ++d) {
      const Eigen::Vector3d& g = factor[d];
      const Eigen::Vector3d moved = tangent.gradient * g;
      offsets.segment<3>(3 * d) += moved - g;
      if (derivatives == nullptr) continue;
      Eigen::Matrix<double, 3, 6> stretch;
      stretch << g[0], 0, 0, g[1], g[2], 0,  //
          0, g[1], 0, g[0], 0, g[2],         //
          0, 0, g[2], 0, g[0], g[1];
      Eigen::Matrix<double, 3, 9> change;
      change << -CrossMatrix(moved) * tangent.jacobian, tangent.rotation * stretch;
      for (const GradientPose::Entry& entry : entries) {
        derivatives->block<3, 1>(3 * d, entry.component) += change * ValuesOf(entry);
      }
    }
  });
  return offsets;
}

}  // namespace sac

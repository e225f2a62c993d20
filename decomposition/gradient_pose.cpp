// SPDX-License-Identifier: Apache-2.0
#include "decomposition/gradient_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "geometry/bounding_box.h"
#include "geometry/deformation.h"

namespace sac {
namespace {

constexpr std::size_t kMostInGroup = 16;  // triangles
constexpr double kAlike = 0.15;           // radians and strain, of all components' values together

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

// Whether two triangles have nearly the same of each component. Entries are in the order of their components.
bool Alike(std::span<const GradientPose::Entry> a, std::span<const GradientPose::Entry> b) {
  double square = 0;
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    if (j == b.size() || (i < a.size() && a[i].component < b[j].component)) {
      square += ValuesOf(a[i++]).squaredNorm();
    } else if (i == a.size() || b[j].component < a[i].component) {
      square += ValuesOf(b[j++]).squaredNorm();
    } else {
      square += (ValuesOf(a[i++]) - ValuesOf(b[j++])).squaredNorm();
    }
  }
  return square <= kAlike * kAlike;
}

}  // namespace

Status GradientPose::Prepare(const SparseComponents& components, const PositionMatrix& rest) {
  count_ = components.components.size();
  std::vector<std::size_t> next(components.triangles.size() + 1, 0);
  for (const SparseComponent& component : components.components) {
    for (const std::uint32_t j : component.nodes) ++next[j + 1];
  }
  triangle_.clear();
  cells_ = {};
  for (std::size_t j = 0; j + 1 < next.size(); ++j) {
    if (next[j + 1] > 0) {
      triangle_.push_back(static_cast<std::uint32_t>(j));
      cells_.first.push_back(cells_.first.back() + next[j + 1]);
    }
    next[j + 1] += next[j];
  }
  cells_.entries.resize(cells_.first.back());
  for (std::size_t k = 0; k < count_; ++k) {
    const SparseComponent& component = components.components[k];
    for (std::size_t i = 0; i < component.nodes.size(); ++i) {
      Entry& entry = cells_.entries[next[component.nodes[i]]++];
      entry.component = static_cast<std::uint32_t>(k);
      for (std::size_t a = 0; a < 9; ++a) entry.values[a] = component.values[9 * i + a];
    }
  }
  PrepareGroups(components);
  return poisson_.Prepare(rest, components.triangles, components.still);
}

// Triangles along a space-filling curve through their centroids; a group ends where the next one's components differ.
void GradientPose::PrepareGroups(const SparseComponents& components) {
  const Box box = BoundingBox(components.rest);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;  // the code of each cell
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Triangle& t = components.triangles[triangle_[i]];
    std::uint64_t code = 0;
    std::array<std::uint32_t, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double x = (static_cast<double>(components.rest[t[0]][a]) + static_cast<double>(components.rest[t[1]][a]) +
                        static_cast<double>(components.rest[t[2]][a])) /
                       3;
      at[a] =
          static_cast<std::uint32_t>(1023 * std::clamp((x - box.low[a]) / std::max(box.diagonal(), 1e-30), 0.0, 1.0));
    }
    for (int bit = 9; bit >= 0; --bit) {
      for (std::size_t a = 0; a < 3; ++a) code = code << 1 | (at[a] >> bit & 1);
    }
    order.emplace_back(code, static_cast<std::uint32_t>(i));
  }
  std::sort(order.begin(), order.end());
  groups_ = {};
  group_.assign(cells_.size(), 0);
  std::vector<std::uint32_t> members;
  const auto end_group = [&] {
    std::map<std::uint32_t, Channels> sums;
    for (const std::uint32_t i : members) {
      group_[i] = static_cast<std::uint32_t>(groups_.size());
      for (const Entry& entry : cells_.of(i)) {
        sums.emplace(entry.component, Channels::Zero()).first->second += ValuesOf(entry);
      }
    }
    for (const auto& [component, sum] : sums) {
      Entry& entry = groups_.entries.emplace_back();
      entry.component = component;
      for (int a = 0; a < 9; ++a) entry.values[a] = static_cast<float>(sum[a] / static_cast<double>(members.size()));
    }
    groups_.first.push_back(groups_.entries.size());
    members.clear();
  };
  for (const auto& [code, i] : order) {
    const bool full = members.size() == kMostInGroup;
    if (!members.empty() && (full || !Alike(cells_.of(members.front()), cells_.of(i)))) end_group();
    members.push_back(i);
  }
  if (!members.empty()) end_group();
}

template <class Take>
void GradientPose::Cells::ForEach(const Eigen::VectorXd& weights, Take&& take) const {
  for (std::size_t i = 0; i < size(); ++i) {
    double q[9] = {};
    for (const Entry& entry : of(i)) {
      const double w = weights[entry.component];
      for (int a = 0; a < 9; ++a) q[a] += w * static_cast<double>(entry.values[a]);
    }
    take(i, q, of(i));
  }
}

PositionMatrix GradientPose::Shape(const Eigen::VectorXd& weights) const {
  RowMatrix b = RowMatrix::Zero(poisson_.vertices(), 3);
  cells_.ForEach(weights, [&](std::size_t i, const double(&q)[9], std::span<const Entry>) {
    poisson_.AddGradient(triangle_[i], DeformationGradient(q) - Eigen::Matrix3d::Identity(), b, 0);
  });
  return poisson_.ReconstructOffsets(b);
}

RowMatrix GradientPose::Derivatives(const Eigen::VectorXd& weights) const {
  RowMatrix b = RowMatrix::Zero(poisson_.vertices(), 3 * static_cast<Eigen::Index>(count_));
  cells_.ForEach(weights, [&](std::size_t i, const double(&q)[9], std::span<const Entry> entries) {
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
  cells_.ForEach(weights, [&](std::size_t i, const double(&q)[9], std::span<const Entry> entries) {
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

PosedVertices::PosedVertices(const GradientPose& pose, std::span<const std::uint32_t> vertices,
                             const Eigen::VectorXd& weights)
    : pose_(pose),
      vertices_(static_cast<Eigen::Index>(vertices.size())),
      factors_(pose.groups_.size() * vertices.size(), Eigen::Vector3d::Zero()),
      correction_(Eigen::VectorXd::Zero(3 * vertices_)) {
  const RowMatrix rows = pose.poisson_.SolutionRows(vertices);
  const bool bent = !weights.isZero(0);
  Eigen::VectorXd exact = Eigen::VectorXd::Zero(3 * vertices_);
  const auto add = [&](std::size_t i, const Eigen::Matrix3d& change) {
    for (Eigen::Index d = 0; d < vertices_; ++d) {
      const Eigen::Vector3d factor = pose.poisson_.GradientOfRow(pose.triangle_[i], rows, d);
      factors_[pose.group_[i] * vertices.size() + static_cast<std::size_t>(d)] += factor;
      if (bent) exact.segment<3>(3 * d) += change * factor;
    }
  };
  if (!bent) {
    for (std::size_t i = 0; i < pose.cells_.size(); ++i) add(i, Eigen::Matrix3d::Zero());
    return;
  }
  pose.cells_.ForEach(weights, [&](std::size_t i, const double(&q)[9], std::span<const GradientPose::Entry>) {
    add(i, DeformationGradient(q) - Eigen::Matrix3d::Identity());
  });
  correction_ = exact - Offsets(weights);
}

Eigen::VectorXd PosedVertices::Offsets(const Eigen::VectorXd& weights, Eigen::MatrixXd* derivatives) const {
  Eigen::VectorXd offsets = Eigen::VectorXd::Zero(3 * vertices_);
  if (derivatives != nullptr) *derivatives = Eigen::MatrixXd::Zero(3 * vertices_, weights.size());
  pose_.groups_.ForEach(weights, [&](std::size_t i, const double(&q)[9], std::span<const GradientPose::Entry> entries) {
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
  return offsets + correction_;
}

}  // namespace sac

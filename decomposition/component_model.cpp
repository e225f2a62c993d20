// SPDX-License-Identifier: Apache-2.0
#include "decomposition/component_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "decomposition/bounded_least_squares.h"
#include "geometry/triangle_fields.h"

namespace sac {
namespace {

constexpr double kRidge = 1e-6;          // of the mean diagonal, of a fit of displacements
constexpr double kGradientRidge = 1e-3;  // the same of a fit of positions by gradients
constexpr int kPoseRounds = 3;           // of fitting and of moving the target onto what was fitted
constexpr int kGaussNewtonSteps = 2;
constexpr int kDragSteps = 5;      // Gauss-Newton, gradient domain
constexpr double kDamping = 1e-9;  // of the mean diagonal, of a drag

Eigen::MatrixXd WithRidge(Eigen::MatrixXd h, double ridge) {
  h.diagonal().array() += ridge * h.trace() / static_cast<double>(std::max<Eigen::Index>(1, h.rows()));
  return h;
}

}  // namespace

Status ComponentModel::Prepare(SparseComponents components) {
  components_ = std::move(components);
  alignment_ = std::make_unique<RestAlignment>(MatrixOf(components_.rest), components_.triangles);
  if (gradient()) {
    SAC_RETURN_IF_ERROR(pose_.Prepare(components_, alignment_->rest()));
    mass_ = pose_.poisson().areas() / pose_.poisson().areas().sum();
  } else {
    mass_ = alignment_->mass();
  }
  PrepareNormal();
  return Status::Ok();
}

// Node by node over the components that the node has.
void ComponentModel::PrepareNormal() {
  struct Entry {
    std::uint32_t component;
    const float* value;
  };
  std::vector<std::vector<Entry>> of_node(components_.nodes());
  const std::size_t channels = components_.channels();
  for (std::size_t k = 0; k < components_.components.size(); ++k) {
    const SparseComponent& c = components_.components[k];
    for (std::size_t i = 0; i < c.nodes.size(); ++i) {
      of_node[c.nodes[i]].push_back({static_cast<std::uint32_t>(k), c.values.data() + i * channels});
    }
  }
  const auto count = static_cast<Eigen::Index>(components_.components.size());
  normal_ = Eigen::MatrixXd::Zero(count, count);
  for (std::size_t i = 0; i < of_node.size(); ++i) {
    for (const Entry& a : of_node[i]) {
      for (const Entry& b : of_node[i]) {
        double dot = 0;
        for (std::size_t c = 0; c < channels; ++c) {
          dot += static_cast<double>(a.value[c]) * static_cast<double>(b.value[c]);
        }
        normal_(a.component, b.component) += mass_[static_cast<Eigen::Index>(i)] * dot;
      }
    }
  }
}

PositionMatrix ComponentModel::Shape(const Eigen::VectorXd& weights) const {
  if (gradient()) return pose_.Shape(weights);
  PositionMatrix shape = alignment_->rest();
  for (std::size_t k = 0; k < components_.components.size(); ++k) {
    const double w = weights[static_cast<Eigen::Index>(k)];
    if (w == 0) continue;
    const SparseComponent& c = components_.components[k];
    for (std::size_t i = 0; i < c.nodes.size(); ++i) {
      for (int a = 0; a < 3; ++a) {
        shape(c.nodes[i], a) += w * static_cast<double>(c.values[3 * i + static_cast<std::size_t>(a)]);
      }
    }
  }
  return shape;
}

// The weights within bounds whose channels come nearest to `values`, nodes x channels.
Eigen::VectorXd ComponentModel::FitChannels(const Eigen::MatrixXd& values) const {
  const std::size_t channels = components_.channels();
  Eigen::VectorXd g = Eigen::VectorXd::Zero(normal_.rows());
  for (std::size_t k = 0; k < components_.components.size(); ++k) {
    const SparseComponent& c = components_.components[k];
    double sum = 0;
    for (std::size_t i = 0; i < c.nodes.size(); ++i) {
      double dot = 0;
      for (std::size_t a = 0; a < channels; ++a) {
        dot += static_cast<double>(c.values[i * channels + a]) * values(c.nodes[i], static_cast<Eigen::Index>(a));
      }
      sum += mass_[c.nodes[i]] * dot;
    }
    g[static_cast<Eigen::Index>(k)] = sum;
  }
  return BoundedLeastSquares(WithRidge(normal_, kRidge), g, Eigen::VectorXd::Zero(g.size()), low(), 1);
}

Eigen::VectorXd ComponentModel::FitDisplacements(const PositionMatrix& target, RigidPose& pose) const {
  Eigen::VectorXd w = FitChannels(alignment_->Align(target, pose) - alignment_->rest());
  for (int round = 1; round < kPoseRounds; ++round) {
    const RestAlignment fitted(Shape(w), components_.triangles);
    w = FitChannels(fitted.Align(target, pose) - alignment_->rest());
  }
  return w;
}

Eigen::VectorXd ComponentModel::FitGradients(const PositionMatrix& target, RigidPose& pose) const {
  const PositionMatrix aligned = alignment_->Align(target, pose);
  TriangleFields fields(components_.triangles);
  Eigen::VectorXd w = FitChannels(fields.Measure(alignment_->rest(), aligned));
  const Eigen::VectorXd root = alignment_->mass().cwiseSqrt();
  for (int step = 0; step < kGaussNewtonSteps; ++step) {
    const RestAlignment fitted(pose_.Shape(w), components_.triangles);
    const RowMatrix left = root.asDiagonal() * (fitted.Align(target, pose) - fitted.rest());
    RowMatrix derivatives = root.asDiagonal() * pose_.Derivatives(w);
    // Vertices x (3 count) as (3 vertices) x count: the three columns of a component become one.
    Eigen::MatrixXd normal(w.size(), w.size());
    Eigen::VectorXd g(w.size());
    Eigen::MatrixXd columns(3 * derivatives.rows(), w.size());
    for (Eigen::Index k = 0; k < w.size(); ++k) {
      for (Eigen::Index a = 0; a < 3; ++a) {
        columns.col(k).segment(a * derivatives.rows(), derivatives.rows()) = derivatives.col(3 * k + a);
      }
    }
    normal.noalias() = columns.transpose() * columns;
    Eigen::VectorXd residual(3 * left.rows());
    for (Eigen::Index a = 0; a < 3; ++a) residual.segment(a * left.rows(), left.rows()) = left.col(a);
    normal = WithRidge(normal, kGradientRidge);
    g = columns.transpose() * residual;
    // In terms of the weights themselves, so that their bounds hold; the ridge is on the change.
    w = BoundedLeastSquares(normal, g + normal * w, w, low(), 1);
  }
  const RestAlignment fitted(pose_.Shape(w), components_.triangles);
  fitted.Align(target, pose);
  return w;
}

Eigen::VectorXd ComponentModel::Fit(const PositionMatrix& target, RigidPose& pose) const {
  return gradient() ? FitGradients(target, pose) : FitDisplacements(target, pose);
}

// 3 a target x count.
Eigen::MatrixXd ComponentModel::DerivativesAt(const Eigen::VectorXd& weights,
                                              std::span<const DragTarget> targets) const {
  std::vector<std::uint32_t> vertices;
  for (const DragTarget& target : targets) vertices.push_back(target.vertex);
  if (gradient()) return pose_.DerivativesAt(weights, vertices);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(vertices.size()), weights.size());
  for (std::size_t k = 0; k < components_.components.size(); ++k) {
    const SparseComponent& c = components_.components[k];
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const auto found = std::lower_bound(c.nodes.begin(), c.nodes.end(), vertices[i]);
      if (found == c.nodes.end() || *found != vertices[i]) continue;
      const float* value = c.values.data() + 3 * (found - c.nodes.begin());
      for (int a = 0; a < 3; ++a) {
        b(3 * static_cast<Eigen::Index>(i) + a, static_cast<Eigen::Index>(k)) = static_cast<double>(value[a]);
      }
    }
  }
  return b;
}

Eigen::VectorXd ComponentModel::Drag(std::span<const DragTarget> targets, const DragSettings& settings,
                                     const Eigen::VectorXd& start) const {
  const auto rows = 3 * static_cast<Eigen::Index>(targets.size());
  if (rows == 0 || start.size() == 0) return start;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> r(settings.pose.rotation.data());
  const Eigen::Map<const Eigen::Vector3d> t(settings.pose.translation.data());
  Eigen::VectorXd wanted(rows);  // in the frame of the rest shape
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Vec3f& p = targets[i].position;
    const Eigen::Vector3d at(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
    wanted.segment<3>(3 * static_cast<Eigen::Index>(i)) = r.transpose() * (at - t);
  }
  const auto miss = [&](const Eigen::VectorXd& w) {
    const PositionMatrix shape = Shape(w);
    Eigen::VectorXd d = wanted;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      d.segment<3>(3 * static_cast<Eigen::Index>(i)) -= shape.row(targets[i].vertex).transpose();
    }
    return d;
  };
  const Eigen::VectorXd size = normal_.diagonal().cwiseSqrt();
  const double typical = std::sqrt(size.squaredNorm() / static_cast<double>(size.size()));
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd lower =
      settings.bounded ? Eigen::VectorXd(low() - start.array()) : Eigen::VectorXd::Constant(start.size(), -infinity);
  const Eigen::VectorXd upper =
      settings.bounded ? Eigen::VectorXd(1 - start.array()) : Eigen::VectorXd::Constant(start.size(), infinity);
  const double distance = miss(start).norm();
  Eigen::VectorXd w = start;
  for (int step = 0; step < (gradient() ? kDragSteps : 1); ++step) {
    const Eigen::MatrixXd b = DerivativesAt(w, targets);
    const Eigen::VectorXd goal = miss(w) + b * (w - start);
    Eigen::MatrixXd h = WithRidge(b.transpose() * b, kDamping);
    const double largest = h.diagonal().maxCoeff();
    if (!(largest > 0) || !(typical > 0)) break;  // nothing reaches the targets
    Eigen::VectorXd price = settings.price * distance * std::sqrt(largest) / typical * size;
    if (!settings.sparse) {
      h.diagonal() += settings.price * largest / (typical * typical) * size.cwiseAbs2();
      price.setZero();
    }
    w = start + SparseLeastSquares(h, b.transpose() * goal, price, lower, upper);
  }
  return w;
}

}  // namespace sac

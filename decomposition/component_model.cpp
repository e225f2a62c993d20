// SPDX-License-Identifier: Apache-2.0
#include "decomposition/component_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "decomposition/bounded_least_squares.h"
#include "geometry/triangle_fields.h"

namespace sac {
namespace {

constexpr double kRidge = 1e-6;           // of the mean diagonal, of a fit of displacements
constexpr double kGradientRidge = 1e-3;   // the same of a fit of positions by gradients
constexpr int kPoseRounds = 3;            // of fitting and of moving the target onto what was fitted
constexpr int kFitSteps = 4;              // of a fit of positions by gradients, at most
constexpr double kLeastCurvature = 1e-3;  // along a step, of what was expected: below, nothing is learnt from it
constexpr double kFitProgress = 0.05;     // share by which the last of them lowered the square of the error
constexpr int kDragSteps = 5;             // Gauss-Newton, gradient domain
constexpr double kDragTolerance = 1e-2;   // of how far the weights have moved: a change after which a drag ends
constexpr double kDamping = 1e-9;         // of the mean diagonal, of a drag
// Triangles where weights are first looked for: all in all, and of each component.
constexpr std::size_t kSample = 1600, kLeastSample = 4, kMostSample = 128;

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
  if (gradient()) PrepareSample();
  return Status::Ok();
}

void ComponentModel::PrepareSample() {
  const std::size_t count = components_.components.size();
  const std::size_t of_each = std::clamp(kSample / std::max<std::size_t>(1, count), kLeastSample, kMostSample);
  constexpr std::uint32_t kNot = 0xffffffffu;
  std::vector<std::uint32_t> row(components_.triangles.size(), kNot);  // of a triangle, in the sample
  for (const SparseComponent& c : components_.components) {
    std::vector<std::pair<double, std::uint32_t>> sizes;
    for (std::size_t i = 0; i < c.nodes.size(); ++i) {
      const Eigen::Map<const Eigen::Matrix<float, 9, 1>> value(c.values.data() + 9 * i);
      sizes.emplace_back(-mass_[c.nodes[i]] * value.cast<double>().squaredNorm(), c.nodes[i]);
    }
    const auto end = sizes.begin() + static_cast<std::ptrdiff_t>(std::min(of_each, sizes.size()));
    std::partial_sort(sizes.begin(), end, sizes.end());
    for (auto it = sizes.begin(); it != end; ++it) {
      if (row[it->second] != kNot) continue;
      row[it->second] = static_cast<std::uint32_t>(sample_.size());
      sample_.push_back(components_.triangles[it->second]);
    }
  }
  sample_roots_.resize(static_cast<Eigen::Index>(sample_.size()));
  for (std::size_t j = 0; j < row.size(); ++j) {
    if (row[j] != kNot) sample_roots_[row[j]] = std::sqrt(mass_[static_cast<Eigen::Index>(j)]);
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < count; ++k) {
    const SparseComponent& c = components_.components[k];
    for (std::size_t i = 0; i < c.nodes.size(); ++i) {
      const std::uint32_t r = row[c.nodes[i]];
      if (r == kNot) continue;
      for (std::size_t a = 0; a < 9; ++a) {
        entries.emplace_back(static_cast<int>(9 * r + a), static_cast<int>(k),
                             sample_roots_[r] * static_cast<double>(c.values[9 * i + a]));
      }
    }
  }
  sample_values_.resize(9 * sample_roots_.size(), static_cast<Eigen::Index>(count));
  sample_values_.setFromTriplets(entries.begin(), entries.end());
  sample_normal_ = WithRidge(sample_values_.transpose() * sample_values_, kRidge);
}

// The weights that explain the gradients of the sample.
Eigen::VectorXd ComponentModel::FitSample(const PositionMatrix& aligned) const {
  TriangleFields fields(sample_);
  const RowMatrix measured = sample_roots_.asDiagonal() * fields.Measure(alignment_->rest(), aligned);
  const Eigen::VectorXd g =
      sample_values_.transpose() * Eigen::Map<const Eigen::VectorXd>(measured.data(), measured.size());
  return BoundedLeastSquares(sample_normal_, g, Eigen::VectorXd::Zero(g.size()), low(), 1);
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

// The inner products of what each weight moves at rest, count x count. Where limbs turn it moves them in other
// directions, but hardly by more or less.
const Eigen::MatrixXd& ComponentModel::PositionNormal() const {
  std::call_once(position_normal_made_, [this] {
    const auto count = normal_.rows();
    const RowMatrix moved = pose_.Derivatives(Eigen::VectorXd::Zero(count));
    Eigen::MatrixXd columns(3 * moved.rows(), count);  // the three columns of a component become one
    const Eigen::VectorXd root = alignment_->mass().cwiseSqrt();
    for (Eigen::Index k = 0; k < count; ++k) {
      for (Eigen::Index a = 0; a < 3; ++a) {
        columns.col(k).segment(a * moved.rows(), moved.rows()) = root.cwiseProduct(moved.col(3 * k + a));
      }
    }
    position_normal_ = WithRidge(columns.transpose() * columns, kGradientRidge);
  });
  return position_normal_;
}

// Quasi-Newton (BFGS) within the bounds: the gradient of the error is exact, the second derivative that of
// PositionNormal() until steps have shown better. A step that does not lower the error is halved.
Eigen::VectorXd ComponentModel::FitGradients(const PositionMatrix& target, RigidPose& pose) const {
  const Eigen::VectorXd& mass = alignment_->mass();
  Eigen::VectorXd w = FitSample(alignment_->Align(target, pose)), best = w, last_g;
  Eigen::MatrixXd normal = PositionNormal();
  double least = std::numeric_limits<double>::infinity();
  for (int step = 0; step <= kFitSteps; ++step) {
    const PositionMatrix shape = pose_.Shape(w);
    RigidPose found;
    const RowMatrix left = alignment_->AlignOnto(shape, target, found) - shape;
    const double error = left.rowwise().squaredNorm().dot(mass);
    if (!(error < least)) {
      w = (w + best) / 2;
      continue;
    }
    const bool ends = step == kFitSteps || least - error < kFitProgress * least;
    const Eigen::VectorXd moved = w - best;
    best = w;
    least = error;
    pose = found;
    if (ends) break;
    const Eigen::VectorXd g = pose_.DerivativesOfSum(w, mass.asDiagonal() * left);
    if (step > 0) {
      const Eigen::VectorXd change = last_g - g, expected = normal * moved;
      const double curvature = moved.dot(change), size = moved.dot(expected);
      if (curvature > kLeastCurvature * size) {
        normal += change * change.transpose() / curvature - expected * expected.transpose() / size;
      }
    }
    last_g = g;
    w = BoundedLeastSquares(normal, g + normal * w, w, low(), 1);
  }
  return best;
}

Eigen::VectorXd ComponentModel::Fit(const PositionMatrix& target, RigidPose& pose) const {
  return gradient() ? FitGradients(target, pose) : FitDisplacements(target, pose);
}

// 3 a target x count, of displacements.
Eigen::MatrixXd ComponentModel::DerivativesAt(std::span<const DragTarget> targets) const {
  const auto count = static_cast<Eigen::Index>(components_.components.size());
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(targets.size()), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const SparseComponent& c = components_.components[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const auto found = std::lower_bound(c.nodes.begin(), c.nodes.end(), targets[i].vertex);
      if (found == c.nodes.end() || *found != targets[i].vertex) continue;
      const float* value = c.values.data() + 3 * (found - c.nodes.begin());
      for (int a = 0; a < 3; ++a) b(3 * static_cast<Eigen::Index>(i) + a, k) = static_cast<double>(value[a]);
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
  std::vector<std::uint32_t> vertices;
  for (const DragTarget& target : targets) {
    vertices.push_back(target.vertex);
    wanted.segment<3>(3 * static_cast<Eigen::Index>(vertices.size() - 1)) -=
        alignment_->rest().row(target.vertex).transpose();
  }
  Eigen::MatrixXd b = DerivativesAt(targets);
  std::optional<PosedVertices> posed;
  if (gradient()) posed.emplace(pose_, vertices, start);
  // How far the vertices are from their targets; `b` becomes how that changes.
  const auto miss = [&](const Eigen::VectorXd& w) {
    return Eigen::VectorXd(wanted - (posed ? posed->Offsets(w, &b) : Eigen::VectorXd(b * w)));
  };
  const Eigen::VectorXd size = normal_.diagonal().cwiseSqrt();
  const double typical = std::sqrt(size.squaredNorm() / static_cast<double>(size.size()));
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd lower =
      settings.bounded ? Eigen::VectorXd(low() - start.array()) : Eigen::VectorXd::Constant(start.size(), -infinity);
  const Eigen::VectorXd upper =
      settings.bounded ? Eigen::VectorXd(1 - start.array()) : Eigen::VectorXd::Constant(start.size(), infinity);
  Eigen::VectorXd left = miss(start), w = start;
  const double distance = left.norm();
  for (int step = 0; step < (gradient() ? kDragSteps : 1); ++step) {
    if (step > 0) left = miss(w);
    const Eigen::VectorXd goal = left + b * (w - start);
    Eigen::MatrixXd h = WithRidge(b.transpose() * b, kDamping);
    const double largest = h.diagonal().maxCoeff();
    if (!(largest > 0) || !(typical > 0)) break;  // nothing reaches the targets
    Eigen::VectorXd price = settings.price * distance * std::sqrt(largest) / typical * size;
    if (!settings.sparse) {
      h.diagonal() += settings.price * largest / (typical * typical) * size.cwiseAbs2();
      price.setZero();
    }
    const Eigen::VectorXd before = w;
    w = start + SparseLeastSquares(h, b.transpose() * goal, price, lower, upper);
    if ((w - before).norm() <= kDragTolerance * (w - start).norm()) break;
  }
  return w;
}

}  // namespace sac

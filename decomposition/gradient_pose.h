// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "decomposition/poisson.h"
#include "sac/sparse_components.h"
#include "sac/status.h"

namespace sac {

// The shapes that components of deformation gradients pose, and how they change with the weights.
class GradientPose {
 public:
  // `components` must live as long. Errors as of PoissonReconstruction::Prepare().
  Status Prepare(const SparseComponents& components, const PositionMatrix& rest);

  // The channels of each triangle, triangles x 9.
  Eigen::MatrixXd Channels(const Eigen::VectorXd& weights) const;
  PositionMatrix Shape(const Eigen::VectorXd& weights) const;

  // The derivatives of all positions with respect to each weight: vertices x 3 count, three columns a component.
  RowMatrix Derivatives(const Eigen::VectorXd& weights) const;

  // The derivatives of the positions of `vertices` alone: 3 a vertex x count. They take one solution a vertex, not
  // three a component.
  Eigen::MatrixXd DerivativesAt(const Eigen::VectorXd& weights, std::span<const std::uint32_t> vertices) const;

  const PoissonReconstruction& poisson() const { return poisson_; }

 private:
  const SparseComponents* components_ = nullptr;
  PoissonReconstruction poisson_;
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "decomposition/gradient_pose.h"
#include "decomposition/rest_alignment.h"
#include "sac/component_poser.h"
#include "sac/sparse_components.h"
#include "sac/status.h"

namespace sac {

// Components with what poses, fits and drags need of them; see ComponentPoser.
class ComponentModel {
 public:
  ComponentModel() = default;
  ComponentModel(const ComponentModel&) = delete;
  ComponentModel& operator=(const ComponentModel&) = delete;

  Status Prepare(SparseComponents components);

  const SparseComponents& components() const { return components_; }
  const RestAlignment& alignment() const { return *alignment_; }

  PositionMatrix Shape(const Eigen::VectorXd& weights) const;
  Eigen::VectorXd Fit(const PositionMatrix& target, RigidPose& pose) const;
  Eigen::VectorXd Drag(std::span<const DragTarget> targets, const DragSettings& settings,
                       const Eigen::VectorXd& start) const;

 private:
  double low() const { return components_.positive ? 0 : -1; }
  bool gradient() const { return components_.domain == ComponentDomain::kGradient; }
  void PrepareNormal();
  void PrepareSample();
  Eigen::VectorXd FitSample(const PositionMatrix& aligned) const;
  Eigen::VectorXd FitChannels(const Eigen::MatrixXd& values) const;
  Eigen::VectorXd FitDisplacements(const PositionMatrix& target, RigidPose& pose) const;
  Eigen::VectorXd FitGradients(const PositionMatrix& target, RigidPose& pose) const;
  const Eigen::MatrixXd& PositionNormal() const;
  Eigen::MatrixXd DerivativesAt(std::span<const DragTarget> targets) const;

  SparseComponents components_;
  std::unique_ptr<RestAlignment> alignment_;
  GradientPose pose_;       // gradient domain only
  Eigen::VectorXd mass_;    // of nodes
  Eigen::MatrixXd normal_;  // C m C^T, count x count
  // Of gradients: the triangles where components are largest, and the components there, 9 a triangle x count, times the
  // root of the mass.
  std::vector<Triangle> sample_;
  Eigen::VectorXd sample_roots_;
  Eigen::SparseMatrix<double> sample_values_;
  Eigen::MatrixXd sample_normal_;
  mutable std::once_flag position_normal_made_;
  mutable Eigen::MatrixXd position_normal_;  // see PositionNormal()
};

}  // namespace sac

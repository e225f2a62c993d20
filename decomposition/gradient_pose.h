// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
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
  // What a component has at a triangle.
  struct Entry {
    std::uint32_t component;
    float values[9];
  };

  // Errors as of PoissonReconstruction::Prepare().
  Status Prepare(const SparseComponents& components, const PositionMatrix& rest);

  PositionMatrix Shape(const Eigen::VectorXd& weights) const;

  // The derivatives of all positions with respect to each weight: vertices x 3 count, three columns a component.
  RowMatrix Derivatives(const Eigen::VectorXd& weights) const;

  // The derivatives of the sum of `y` (vertices x 3) times the positions with respect to each weight. It takes one
  // solution of the system, not one a component.
  Eigen::VectorXd DerivativesOfSum(const Eigen::VectorXd& weights, RowMatrix y) const;

  const PoissonReconstruction& poisson() const { return poisson_; }

 private:
  friend class PosedVertices;

  // The components at each triangle, or at each group of triangles: entries[first[i]] to before entries[first[i + 1]]
  // are those of i.
  struct Cells {
    std::vector<std::size_t> first = {0};
    std::vector<Entry> entries;
    std::size_t size() const { return first.size() - 1; }
    std::span<const Entry> of(std::size_t i) const { return {entries.data() + first[i], first[i + 1] - first[i]}; }
    // Calls `take` for each, with its number, its channels and its entries.
    template <class Take>
    void ForEach(const Eigen::VectorXd& weights, Take&& take) const;
  };

  void PrepareGroups(const SparseComponents& components);

  std::size_t count_ = 0;
  PoissonReconstruction poisson_;
  Cells cells_;                          // the triangles that a component has
  std::vector<std::uint32_t> triangle_;  // of each of these cells
  // Neighbours whose components are nearly the same, as if they were: what they have is the mean.
  Cells groups_;
  std::vector<std::uint32_t> group_;  // of each of the triangles' cells
};

// A few vertices of the shapes that a GradientPose poses. Where they are follows from all gradients by a sum whose
// factors are computed once, so that no system is solved for another set of weights. Triangles are taken in groups:
// exact is what is said of the weights that it was made for.
class PosedVertices {
 public:
  // `pose` must live as long.
  PosedVertices(const GradientPose& pose, std::span<const std::uint32_t> vertices, const Eigen::VectorXd& weights);

  // How far the vertices are from where they are at rest, 3 a vertex, and with `derivatives` also how that changes with
  // each weight, 3 a vertex x count.
  Eigen::VectorXd Offsets(const Eigen::VectorXd& weights, Eigen::MatrixXd* derivatives = nullptr) const;

 private:
  const GradientPose& pose_;
  Eigen::Index vertices_;
  std::vector<Eigen::Vector3d> factors_;  // groups x vertices
  Eigen::VectorXd correction_;            // what the groups miss, 3 a vertex
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "codec/shape.h"

namespace sac {

// Projects fields onto the harmonics by least squares, component by component. Results are harmonics x channels, with
// rows in the order of a plane's coefficients. Threads may share it.
class Projection {
 public:
  // `shape` must outlive the object. `areas` has the weight of each triangle.
  Projection(const Shape& shape, const Eigen::VectorXd& areas);

  // The coefficients whose mean over each triangle's three vertices is nearest to `fields` (triangles x channels),
  // weighted by area: the paper's matrix C (Wang et al. 2015, equation 6).
  Eigen::MatrixXd ProjectTriangles(const Eigen::MatrixXd& fields) const;

  // The coefficients nearest to `field` (vertices x channels), where every vertex has the same weight.
  Eigen::MatrixXd ProjectVertices(const Eigen::MatrixXd& field) const;

  // The same in patch harmonics.
  Eigen::MatrixXd ProjectPatches(const Eigen::MatrixXd& field) const;

 private:
  struct Systems {
    Eigen::LDLT<Eigen::MatrixXd> triangles;
    Eigen::LDLT<Eigen::MatrixXd> vertices;
  };

  Eigen::MatrixXd Solve(const Eigen::MatrixXd& at_vertices, Eigen::LDLT<Eigen::MatrixXd> Systems::*system) const;

  const Shape& shape_;
  Eigen::VectorXd areas_;
  std::vector<Systems> systems_;
};

// The projection onto the harmonics of `shape`, which must outlive it, by the areas of its triangles.
std::unique_ptr<const Projection> ProjectionOf(const Shape& shape);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/laplacian.h"
#include "geometry/sparse_cholesky.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Finds the positions whose deformation gradients against a rest shape are nearest to given ones in the least squares,
// weighted by area (Sumner and Popovic 2004; Yu et al. 2004): a Poisson system with one factorization for all.
// Gradients say nothing of where a connected component is: its centroid is that of the rest shape. Vertices without
// area around them stay where they are at rest, and so do those of `still`, with all their connected component.
class PoissonReconstruction {
 public:
  // Prepares the system. kInvalidArgument for a mesh without area; kLimit where the factor would be too large.
  Status Prepare(const PositionMatrix& rest, std::span<const Triangle> triangles, std::span<const std::uint32_t> still);

  // The positions for the channels `q` (triangles x 9) of each triangle's deformation gradient.
  PositionMatrix Reconstruct(const Eigen::MatrixXd& q) const;
  // The same for right sides that AddGradient() has made of what each gradient differs from the identity by; `b`, which
  // is vertices x 3, becomes the offsets.
  PositionMatrix ReconstructOffsets(RowMatrix& b) const;

  // The right side of one triangle's gradient J, or of a derivative of it, added to the 3 columns from `first` of `b`.
  void AddGradient(std::size_t triangle, const Eigen::Matrix3d& j, RowMatrix& b, Eigen::Index first) const;
  // Solves for right sides, three columns each, in place: offsets whose connected components have their centroids, or
  // what is still, at 0. The columns are those of derivatives.
  void SolveOffsets(RowMatrix& b) const;

  // The transpose of SolveOffsets(), in place: what a change of the right side at each vertex adds to the sum of `y`
  // times the offsets.
  void SolveTransposed(RowMatrix& y) const;
  // What the position of each of `vertices` is of all right sides, vertices x vertices.size().
  RowMatrix SolutionRows(std::span<const std::uint32_t> vertices) const;
  // The integral over a triangle of the gradient of three columns from `first` of what SolveTransposed() gives, each a
  // row: a change D of the gradient there adds the sum of the products of its entries and these.
  Eigen::Matrix3d GradientOfRows(std::size_t triangle, const RowMatrix& rows, Eigen::Index first) const {
    const Triangle& t = triangles_[triangle];
    Eigen::Matrix3d corners;
    corners << rows.block<1, 3>(t[0], first).transpose(), rows.block<1, 3>(t[1], first).transpose(),
        rows.block<1, 3>(t[2], first).transpose();
    return areas_[static_cast<Eigen::Index>(triangle)] * corners * hats_[triangle].transpose();
  }
  // The same of one column of SolutionRows(): a gradient J there moves that vertex by J times this.
  Eigen::Vector3d GradientOfRow(std::size_t triangle, const RowMatrix& rows, Eigen::Index column) const {
    const Triangle& t = triangles_[triangle];
    const Eigen::Vector3d corners(rows(t[0], column), rows(t[1], column), rows(t[2], column));
    return areas_[static_cast<Eigen::Index>(triangle)] * (hats_[triangle] * corners);
  }

  // The area of each triangle, 0 where it has no gradient.
  const Eigen::VectorXd& areas() const { return areas_; }
  // Vertices without area around them.
  std::uint32_t loose_vertices() const { return loose_; }
  Eigen::Index vertices() const { return rest_.rows(); }

 private:
  void PrepareTriangles();
  void LabelPieces(std::span<const std::uint32_t> still);
  SparseCholesky::Matrix System() const;
  void Place(RowMatrix& offsets) const;

  PositionMatrix rest_;
  std::vector<Triangle> triangles_;
  Eigen::VectorXd areas_;
  std::vector<Eigen::Matrix3d> hats_;  // columns: the gradients of the corners' hat functions, 1 / model unit
  std::vector<std::uint32_t> piece_;   // the connected component of each vertex over triangles with area
  std::uint32_t pieces_ = 0, loose_ = 0;
  Eigen::VectorXd mass_;  // of vertices, for centroids
  Eigen::VectorXd piece_mass_;
  std::vector<char> held_;   // pieces that still vertices hold
  std::vector<char> still_;  // vertices
  SparseCholesky factor_;
};

}  // namespace sac

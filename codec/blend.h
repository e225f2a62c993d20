// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/handles.h"
#include "geometry/components.h"
#include "geometry/edges.h"
#include "geometry/laplacian.h"
#include "geometry/sparse_cholesky.h"

namespace sac {

using DeformationGradients = std::vector<Eigen::Matrix3d>;  // one a handle

// A symmetric matrix over the vertices of a mesh that has values at vertices and at edges only.
struct VertexMatrix {
  const Eigen::VectorXd& diagonal;       // of each vertex
  std::span<const double> off_diagonal;  // of each edge; empty: all 0
};

// The linear blend of a mesh's handles (spec.md 6.4.5): each function of the blend moves all vertices that follow its
// handle. A handle i of a component with fewer handles than vertices has four, at vertex v
//   w_i(v) (y_v - y_i)_x, w_i(v) (y_v - y_i)_y, w_i(v) (y_v - y_i)_z, w_i(v),
// y the positions of M'0 and w_i the handle's weights; any other has one, which is 1 at its own vertex. The matrix Psi
// has one row for each vertex and one column for each function.
class Blend {
 public:
  Blend() = default;
  // `positions`: y, model units. The vertices of each of `components` are consecutive.
  Blend(Handles handles, std::vector<Component> components, const EdgeGraph& graph, const PositionMatrix& positions,
        const Eigen::RowVector3d& centre);

  const Handles& handles() const { return handles_; }
  // The run of functions of each component.
  const std::vector<Component>& functions() const { return functions_; }
  std::uint32_t columns() const { return columns_; }
  // Whether the handles of component `c` have four functions each.
  bool IsAffine(std::size_t c) const { return functions_[c].count != handles_.components[c].count; }
  // The function that moves all that follows a handle alike.
  std::uint32_t Translation(std::size_t c, std::uint32_t handle) const {
    const std::uint32_t i = handle - handles_.components[c].first, width = Width(c);
    return functions_[c].first + width * i + width - 1;
  }

  // Makes of the coefficients `z` of all functions, functions x 3, the coefficients of the same blend about the origin:
  // with (y_v - centre)_x instead of (y_v - y_i)_x and so on.
  void MoveToOrigin(RowMatrix& z) const;
  // Moves what coefficients about the origin give by `by`.
  void Translate(const Eigen::RowVector3d& by, RowMatrix& about_origin) const;
  // The positions that such coefficients give: Psi z.
  void Apply(const RowMatrix& about_origin, PositionMatrix& out) const;
  // Psi^T field, field vertices x channels.
  Eigen::MatrixXd TransposeTimes(const Eigen::MatrixXd& field) const;
  // The rows of Psi at the vertices of component `c`'s handles times `z`, which has a row for each of its functions.
  Eigen::MatrixXd AtHandles(std::size_t c, const Eigen::MatrixXd& z) const;
  // Psi^T M Psi of the functions of component `c`, of which only the lower triangle is stored. `graph` is the mesh's.
  Eigen::SparseMatrix<double> Congruence(std::size_t c, const EdgeGraph& graph, const VertexMatrix& m) const;

  // Adds the values of component `c` to those of the matrix P that takes the deformation gradients of handles to what
  // pulls at the functions (spec.md 6.5.3): a row for each function, three columns for each handle. `reference` is the
  // shape whose edges are deformed, `weights` are the edges'.
  void AddPull(std::size_t c, const EdgeGraph& graph, std::span<const double> weights, const PositionMatrix& reference,
               std::vector<Eigen::Triplet<double>>& entries) const;

 private:
  using Functions = Eigen::Vector4d;  // the values of a handle's four functions at a vertex
  std::uint32_t Width(std::size_t c) const { return IsAffine(c) ? 4 : 1; }
  Functions At(std::uint32_t vertex, std::uint32_t handle, double weight) const;
  // The pairs of handles of a component one of which moves a vertex that the other moves, or a neighbour of it: handle
  // i is paired with columns[offsets[i]] to columns[offsets[i + 1] - 1], ascending. Handles are numbered within the
  // component.
  struct Pairs {
    std::vector<std::size_t> offsets;
    std::vector<std::uint32_t> columns;
  };
  Pairs PairsOf(std::size_t c, const EdgeGraph& graph) const;
  template <int kWidth>
  class Row;
  template <int kWidth, class FillRow, class Emit>
  void SumOverVertices(std::size_t c, FillRow&& fill_row, Emit&& emit) const;

  Handles handles_;
  std::vector<Component> components_, functions_;
  std::uint32_t columns_ = 0;
  std::vector<Pairs> pairs_;  // of each component; empty where it is not affine
  PositionMatrix offsets_;    // y_v - centre of each vertex
};

}  // namespace sac

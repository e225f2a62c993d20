// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/edges.h"
#include "sac/mesh.h"

namespace sac {

// Positions as a matrix: one row a vertex, one column an axis.
using PositionMatrix = Eigen::Matrix<double, Eigen::Dynamic, 3>;

// The cotangent weight of each edge (spec.md 6.4.1): half the sum of the cotangents opposite the edge, at least
// kMinWeight. The bound gives the Laplacian of every connected component exactly one zero eigenvalue, whatever the
// triangles are like.
std::vector<double> CotangentWeights(const PositionMatrix& positions, std::span<const Triangle> triangles,
                                     const EdgeList& edges);
inline constexpr double kMinWeight = 1e-3;

// The mass of each vertex: a third of the areas of the triangles around it, at least a thousandth of the mean, scaled
// so that all masses sum to 1 (spec.md 6.4.1).
Eigen::VectorXd VertexMasses(const PositionMatrix& positions, std::span<const Triangle> triangles);

// The Laplacian of the vertices [first, first + count): the symmetric matrix with -weights off the diagonal and row
// sums of zero, of which only the lower triangle is stored. `ends` and `weights` belong to the edges whose smaller
// vertex is in that range; edges that leave it are ignored.
Eigen::SparseMatrix<double> LaplacianMatrix(std::span<const std::array<std::uint32_t, 2>> ends,
                                            std::span<const double> weights, std::uint32_t first, std::uint32_t count);

}  // namespace sac

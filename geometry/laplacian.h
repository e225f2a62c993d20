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

// One column an axis, one row a vertex.
using PositionMatrix = Eigen::Matrix<double, Eigen::Dynamic, 3>;

// Cotangent weight of each edge (spec.md 6.4.1): half the sum of the cotangents opposite it, at least kMinWeight, so
// that every connected component's Laplacian has exactly one zero eigenvalue whatever the triangles are like.
std::vector<double> CotangentWeights(const PositionMatrix& positions, std::span<const Triangle> triangles,
                                     const EdgeList& edges);
inline constexpr double kMinWeight = 1e-3;

// A third of the areas of the triangles around each vertex, at least a thousandth of the mean; sums to 1
// (spec.md 6.4.1).
Eigen::VectorXd VertexMasses(const PositionMatrix& positions, std::span<const Triangle> triangles);

// The symmetric matrix with -weights off the diagonal and zero row sums, of the vertices [first, first + count), whose
// edges `ends` are. Lower triangle only.
Eigen::SparseMatrix<double> LaplacianMatrix(std::span<const std::array<std::uint32_t, 2>> ends,
                                            std::span<const double> weights, std::uint32_t first, std::uint32_t count);

}  // namespace sac

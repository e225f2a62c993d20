// SPDX-License-Identifier: Apache-2.0
#include "geometry/laplacian.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sac {

std::vector<double> CotangentWeights(const PositionMatrix& positions, std::span<const Triangle> triangles,
                                     const EdgeList& edges) {
  std::vector<double> weights(edges.ends.size(), 0.0);
  for (std::size_t j = 0; j < triangles.size(); ++j) {
    const Eigen::Vector3d p[3] = {positions.row(triangles[j][0]), positions.row(triangles[j][1]),
                                  positions.row(triangles[j][2])};
    const double double_area = (p[1] - p[0]).cross(p[2] - p[0]).norm();
    const double longest =
        std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
    if (longest == 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t e = edges.of_triangle[j][k];
      if (e == EdgeList::kNone) continue;
      const double dot = (p[(k + 1) % 3] - p[k]).dot(p[(k + 2) % 3] - p[k]);
      weights[e] += std::clamp(dot / std::max(double_area, 1e-6 * longest), -5.0, 5.0) / 2;
    }
  }
  for (double& w : weights) w = std::max(w, kMinWeight);
  return weights;
}

Eigen::VectorXd VertexMasses(const PositionMatrix& positions, std::span<const Triangle> triangles) {
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(positions.rows());
  for (const Triangle& t : triangles) {
    const Eigen::Vector3d a = positions.row(t[1]) - positions.row(t[0]), b = positions.row(t[2]) - positions.row(t[0]);
    const double third = a.cross(b).norm() / 6;
    for (const std::uint32_t v : t) masses[v] += third;
  }
  const double mean = masses.mean();
  masses = mean > 0 ? masses.cwiseMax(1e-3 * mean).eval() : Eigen::VectorXd::Ones(positions.rows()).eval();
  return masses / masses.sum();
}

Eigen::SparseMatrix<double> LaplacianMatrix(std::span<const std::array<std::uint32_t, 2>> ends,
                                            std::span<const double> weights, std::uint32_t first, std::uint32_t count) {
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(count);
  for (std::size_t e = 0; e < ends.size(); ++e) {
    if (ends[e][1] >= first + count) continue;  // leaves a patch
    const double w = weights[e];
    const auto a = static_cast<int>(ends[e][0] - first), b = static_cast<int>(ends[e][1] - first);
    entries.emplace_back(b, a, -w);
    diagonal[a] += w;
    diagonal[b] += w;
  }
  for (int v = 0; v < static_cast<int>(count); ++v) entries.emplace_back(v, v, diagonal[v]);
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace sac

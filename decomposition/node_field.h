// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace sac {

using RowMatrixF = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// What is decomposed: X, frames x nodes x channels, kept as X = basis * values. Nodes are vertices (3 channels, their
// displacements) or triangles (9 channels, those of geometry/triangle_fields.h). The columns of one node and channel
// lie together: values[(node * channels + channel) * columns + column].
struct NodeField {
  std::size_t nodes = 0, channels = 0, columns = 0;
  std::vector<float> values;
  Eigen::MatrixXf basis;      // frames x columns, columns orthonormal; empty where the columns are the frames
  std::vector<float> mass;    // one a node, mean 1; 0: the node's values are 0 and it is never a centre
  double dropped_energy = 0;  // the part of |X|^2 that the basis leaves out, from 0 to 1

  std::size_t frames() const { return basis.size() > 0 ? static_cast<std::size_t>(basis.rows()) : columns; }
  const float* row(std::size_t node) const { return values.data() + node * channels * columns; }
  float* row(std::size_t node) { return values.data() + node * channels * columns; }

  // The values of one node at all frames, frames x channels.
  Eigen::MatrixXd OfNode(std::size_t node) const {
    const Eigen::Map<const RowMatrixF> x(row(node), static_cast<Eigen::Index>(channels),
                                         static_cast<Eigen::Index>(columns));
    if (basis.size() == 0) return x.transpose().cast<double>();
    return (basis * x.transpose()).cast<double>();
  }

  // Coefficients of weights (frames x count) in the basis.
  Eigen::MatrixXf Project(const Eigen::MatrixXd& weights) const {
    if (basis.size() == 0) return weights.cast<float>();
    return (basis.cast<double>().transpose() * weights).cast<float>();
  }
};

}  // namespace sac

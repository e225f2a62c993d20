// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "decomposition/node_field.h"

namespace sac {

// Finds, frame by frame, a small basis in which all frames of a clip are nearly contained: a randomized SVD (Halko,
// Martinsson, Tropp 2011) whose test matrix is sparse, so that a frame is read once and forgotten.
class FrameSketch {
 public:
  FrameSketch(std::size_t frames, std::size_t columns);

  // Adds frame `f`: `values` are nodes x channels, `mass` one a node.
  void Add(std::size_t f, const std::vector<float>& values, const std::vector<float>& mass, std::size_t channels);

  // frames x columns, orthonormal.
  Eigen::MatrixXf Basis() const;

 private:
  std::size_t columns_;
  Eigen::MatrixXd sketch_;  // test vectors x frames
};

// Adds frame `f` to the values of `field`, which has a basis; returns the sum of m |x|^2 of the frame.
double AddToBasis(std::size_t f, const std::vector<float>& values, NodeField& field);

// The share of `energy`, the sum of m |X|^2, that the values of `field` do not have.
double DroppedEnergy(const NodeField& field, double energy);

}  // namespace sac

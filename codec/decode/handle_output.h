// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "codec/blend.h"
#include "sac/decoder.h"
#include "sac/mesh.h"

namespace sac {

// Gives out frames as matrices of the handles (Decoder::ReceiveHandles).
class HandleOutput {
 public:
  // `blend` must outlive the object. `positions`: of M'0, model units; `centre`: the origin of the blend's
  // coefficients.
  HandleOutput(const Blend& blend, const PositionMatrix& positions, const Eigen::RowVector3d& centre);

  std::size_t handles() const { return boxes_.size(); }
  BlendWeights Weights() const;
  // Writes the matrices, 12 floats a handle, of coefficients about the origin. Returns a box that holds all vertices
  // that they move.
  Box Fill(const RowMatrix& about_origin, std::span<float> matrices) const;

 private:
  const Blend& blend_;
  Eigen::RowVector3d centre_;
  std::vector<std::uint32_t> functions_;  // of each handle its last function
  std::vector<bool> affine_;              // whether it has three more
  std::vector<Box> boxes_;                // of the vertices that follow each handle, in M'0
};

}  // namespace sac

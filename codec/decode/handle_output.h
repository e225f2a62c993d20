// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/blend.h"
#include "codec/shape.h"
#include "sac/decoder.h"
#include "sac/mesh.h"

namespace sac {

// Gives out frames as matrices of the handles (Decoder::ReceiveHandles).
class HandleOutput {
 public:
  // `shape` must outlive the object.
  explicit HandleOutput(const Shape& shape);

  std::size_t handles() const { return boxes_.size(); }
  // Those of each vertex that decoders give out.
  BlendWeights Weights() const;
  // Writes the matrices, 12 floats a handle, of coefficients about the origin. Returns a box that holds all vertices
  // that they move.
  Box Fill(const RowMatrix& about_origin, std::span<float> matrices) const;

 private:
  const Shape& shape_;
  std::vector<std::uint32_t> functions_;  // of each handle its last function
  std::vector<bool> affine_;              // whether it has three more
  std::vector<Box> boxes_;                // of the vertices that follow each handle, in M'0
};

}  // namespace sac

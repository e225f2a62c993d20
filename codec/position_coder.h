// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/position_predictor.h"
#include "format/bit_mixer.h"
#include "format/grid_position.h"
#include "format/integer_coder.h"
#include "format/range_coder.h"
#include "sac/status.h"

namespace sac {

// Residuals of a vertex along its axes, in coding order, in its steps.
using PositionResidual = std::array<std::int32_t, 3>;

// Writes or reads positions, a vertex at a time (spec.md 5.5.6). Encoder and decoder instantiate the same body.
template <class Coder>
class PositionCoder {
 public:
  PositionCoder();

  // Of the vertex that `predictor` has predicted. False when the position is off a grid of `bits` bits.
  bool Code(Coder& coder, const PositionPredictor& predictor, int bits, PositionResidual& residual,
            GridPosition& position);

 private:
  static constexpr std::size_t kUnary = 14;  // bins of a magnitude that have contexts
  static constexpr std::size_t kKinds = 6;   // of bins that have mixers of their own: zero or not, then unary bins
  static constexpr std::size_t kClasses = 24;
  static constexpr std::size_t kShapes = 5;  // by the number of parallelograms
  static constexpr std::size_t kStates = 4;
  static constexpr std::size_t kInputs = kStates + 1;

  using Bins = std::array<AdaptiveBit, 1 + kUnary>;
  using Contexts = std::array<Bins*, kStates>;

  void CodeBin(Coder& coder, const Contexts& contexts, std::size_t axis, std::size_t bin, bool& value);

  std::vector<Bins> by_surroundings_{kClasses * 3}, by_axis_{kClasses * 3}, by_spread_{kClasses * kShapes},
      by_shape_{8 * kShapes};
  std::vector<Mixer<kInputs>> by_kind_, by_kind_and_axis_;
  std::array<BitModel, 2 * kClasses> signs_;
  UnsignedModels rest_;
};

extern template class PositionCoder<RangeEncoder>;
extern template class PositionCoder<RangeDecoder>;

// Decodes the positions of all vertices of `graph`. kCorrupt when one is off the grid or the code does not end where
// the bytes do.
Status DecodePositions(std::span<const std::uint8_t> bytes, const PositionGraph& graph, const PositionSteps& steps,
                       int bits, std::vector<GridPosition>& positions);

}  // namespace sac

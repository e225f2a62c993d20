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

// The residuals of a vertex along its three axes, in the order in which they are coded, in units of the vertex's step.
using PositionResidual = std::array<std::int32_t, 3>;

// Writes or reads positions, one vertex at a time (spec.md 5.5.6). Encoder and decoder instantiate the same body.
template <class Coder>
class PositionCoder {
 public:
  PositionCoder();

  // Codes the vertex that `predictor` predicted last: writes `residual`, or reads it. `position` gets the vertex's
  // position in grid cells. Returns false when the position is off the grid of `bits` bits per axis.
  bool Code(Coder& coder, const PositionPredictor& predictor, int bits, PositionResidual& residual,
            GridPosition& position);

 private:
  static constexpr std::size_t kUnary = 14;  // bins of a magnitude that have contexts
  static constexpr std::size_t kKinds = 6;   // kinds of bins with own mixers: the zero bin, then by unary index
  static constexpr std::size_t kClasses = 24;
  static constexpr std::size_t kShapes = 5;  // classes of the number of parallelograms
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

// Decodes the positions, in grid cells, of all vertices of `graph`. Returns kCorrupt when a position is off the grid of
// `bits` bits per axis or the code does not end where `bytes` does.
Status DecodePositions(std::span<const std::uint8_t> bytes, const PositionGraph& graph, const PositionSteps& steps,
                       int bits, std::vector<GridPosition>& positions);

}  // namespace sac

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/patches.h"
#include "codec/position_predictor.h"
#include "format/activity.h"
#include "format/integer_coder.h"
#include "format/range_coder.h"
#include "format/status.h"

namespace sac {

// Residuals of a vertex along its axes, in coding order, in its steps.
using PositionResidual = std::array<std::int32_t, 3>;

// Writes or reads positions, a vertex at a time (spec.md 5.5.6). Encoder and decoder instantiate the same body.
template <class Coder>
class PositionCoder {
 public:
  // Of the vertex that `predictor` has predicted. False when the position is off a grid of `bits` bits.
  bool Code(Coder& coder, const PositionPredictor& predictor, int bits, PositionResidual& residual,
            GridPosition& position);

 private:
  struct MagnitudeModels {
    BitModel nonzero;
    std::array<BitModel, 14> unary;
    UnsignedModels rest;
  };

  static constexpr std::size_t kShapes = 4;  // by the number of parallelograms

  std::array<MagnitudeModels, kActivities * kShapes> magnitudes_;
  std::array<BitModel, 2 * kActivities> signs_;
};

extern template class PositionCoder<RangeEncoder>;
extern template class PositionCoder<RangeDecoder>;

// Decodes the positions of all vertices of `graph`. kCorrupt when one is off the grid or the code does not end where
// the bytes do.
Status DecodePositions(std::span<const std::uint8_t> bytes, const PositionGraph& graph, const PositionSteps& steps,
                       int bits, std::vector<GridPosition>& positions);

}  // namespace sac

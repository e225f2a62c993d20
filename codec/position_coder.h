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
#include "format/recorded_bins.h"
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
  static constexpr std::size_t kKinds = 3;   // of bins that have mixers of their own: above 0, 1, and 2 or more
  static constexpr std::size_t kClasses = 24;
  static constexpr std::size_t kSupports = PositionPredictor::kSupports;
  static constexpr std::size_t kContexts = 3;
  static constexpr std::size_t kInputs = kContexts + 1;

  using Bins = std::array<BitModel, 1 + kUnary>;
  using Contexts = std::array<Bins*, kContexts>;

  void CodeBin(Coder& coder, const Contexts& contexts, std::size_t axis, std::size_t bin, bool& value);

  std::vector<Bins> by_misses_{kClasses * 3}, by_disagreement_{kClasses * kSupports}, by_support_{8 * kSupports};
  std::vector<Mixer<kInputs>> by_kind_, by_kind_and_axis_;
  std::array<BitModel, 2 * kClasses> signs_;
  UnsignedModels rest_;
};

extern template class PositionCoder<RecordedBins>;
extern template class PositionCoder<RangeDecoder>;

// Decodes the positions, in grid cells, of all vertices of `graph`, and records their bins in `bins` unless it is null.
// Returns kCorrupt when a position is off the grid of `bits` bits per axis or the code has ended before.
Status DecodePositions(RangeDecoder& range, const PositionGraph& graph, const PositionSteps& steps, int bits,
                       std::vector<GridPosition>& positions, RecordedBins* bins = nullptr);

}  // namespace sac

#include "codec/position_coder.h"

#include <algorithm>
#include <cstdlib>

namespace sac {

template <class Coder>
bool PositionCoder<Coder>::Code(Coder& coder, const PositionPredictor& predictor, int bits, PositionResidual& residual,
                                GridPosition& position) {
  const PositionPredictor::Prediction& p = predictor.now();
  PositionPredictor::Vector offset = {};
  std::int64_t before = p.activity;  // how far off the axes before were
  for (std::size_t j = 0; j < 3; ++j) {
    const std::size_t axis = p.axes[j];
    const std::int64_t expected = predictor.Expected(j, offset);
    const std::size_t activity =
        p.neighbours == 0 ? kActivities - 1 : ActivityClass((p.activity + p.surrounding + before) / 3 / p.step);
    MagnitudeModels& models = magnitudes_[activity * kShapes + std::min(p.parallelograms, kShapes - 1)];

    bool nonzero = residual[j] != 0;
    coder.Bit(models.nonzero, nonzero);
    if (nonzero) {
      const std::int64_t lean = p.relaxed[axis] - 16 * expected;
      bool negative = residual[j] < 0;
      coder.Bit(signs_[2 * ActivityClass(std::abs(lean) / p.step) + (lean < 0 ? 1 : 0)], negative);
      std::uint32_t magnitude = Coder::kDecodes ? 1 : static_cast<std::uint32_t>(std::abs(residual[j]));
      std::size_t step = 0;
      for (; step < models.unary.size(); ++step) {
        bool more = magnitude > step + 1;
        coder.Bit(models.unary[step], more);
        if (!more) break;
        if constexpr (Coder::kDecodes) ++magnitude;
      }
      if (step == models.unary.size()) {
        std::uint32_t rest = magnitude - static_cast<std::uint32_t>(step) - 1;
        CodeUnsigned(coder, models.rest, rest);
        if (rest >> bits != 0) return false;
        magnitude = rest + static_cast<std::uint32_t>(step) + 1;
      }
      residual[j] = negative ? -static_cast<std::int32_t>(magnitude) : static_cast<std::int32_t>(magnitude);
    } else {
      residual[j] = 0;
    }
    const std::int64_t at = expected + residual[j] * p.step;
    if (at < 0 || at >= std::int64_t{1} << bits) return false;
    position[axis] = static_cast<std::uint32_t>(at);
    offset[j] = 16 * at - p.centre[axis];
    before = j == 0 ? std::abs(offset[0]) : (std::abs(offset[0]) + std::abs(offset[1])) / 2;
  }
  return coder.ok();
}

template class PositionCoder<RangeEncoder>;
template class PositionCoder<RangeDecoder>;

Status DecodePositions(std::span<const std::uint8_t> bytes, const PositionGraph& graph, const PositionSteps& steps,
                       int bits, std::vector<GridPosition>& positions) {
  RangeDecoder range(bytes);
  PositionPredictor predictor(graph, steps, bits);
  PositionCoder<RangeDecoder> coder;
  positions.resize(graph.vertices());
  for (const std::uint32_t v : graph.CodingOrder()) {
    PositionResidual residual = {};
    predictor.Predict(v);
    if (!coder.Code(range, predictor, bits, residual, positions[v])) {
      return Status::Corrupt("I-frame: a position off the grid");
    }
    predictor.Learn(positions[v]);
  }
  return range.AtEnd() ? Status::Ok() : Status::Corrupt("I-frame: wrong length of positions");
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/position_coder.h"

#include <algorithm>
#include <cstdlib>

namespace sac {
namespace {

// The context class of `length`, 1/16 of a cell: half octaves of its ratio to `step`, which is in cells.
std::size_t Class(std::int64_t length, std::int64_t step) {
  return std::min<std::size_t>(HalfOctave(static_cast<std::uint32_t>(std::min<std::int64_t>(length / step, 1 << 20))),
                               23);
}

constexpr std::int32_t kWeight = 65536 / 4;

}  // namespace

template <class Coder>
PositionCoder<Coder>::PositionCoder() {
  const Mixer<kInputs> mixer({kWeight, kWeight, kWeight, 0});
  by_kind_.assign(kKinds, mixer);
  by_kind_and_axis_.assign(kKinds * 3, mixer);
}

template <class Coder>
void PositionCoder<Coder>::CodeBin(Coder& coder, const Contexts& contexts, std::size_t axis, std::size_t bin,
                                   bool& value) {
  const std::size_t kind = std::min(bin, kKinds - 1);
  std::array<BitModel*, kContexts> models;
  for (std::size_t i = 0; i < kContexts; ++i) models[i] = &(*contexts[i])[bin];
  std::array<std::int32_t, kInputs> inputs;
  inputs[kContexts] = 256;
  CodeMixed(coder, by_kind_[kind], by_kind_and_axis_[kind * 3 + axis], inputs, models, value);
}

template <class Coder>
bool PositionCoder<Coder>::Code(Coder& coder, const PositionPredictor& predictor, int bits, PositionResidual& residual,
                                GridPosition& position) {
  const PositionPredictor::Prediction& p = predictor.now();
  PositionPredictor::Vector offset = {};
  // The mean prediction error on the axes coded before, 1/16 of a cell. For the first axis the neighbours' error stands
  // in for it.
  std::int64_t before = p.near_miss;
  for (std::size_t j = 0; j < 3; ++j) {
    const std::size_t axis = p.axes[j];
    const std::int64_t expected = predictor.Expected(j, offset);
    const std::size_t misses =
        p.neighbours == 0 ? kClasses - 1 : Class((p.near_miss + p.far_miss + before) / 3, p.step);
    const Contexts contexts = {&by_misses_[misses * 3 + j],
                               &by_disagreement_[Class(p.disagreement, p.step) * kSupports + p.support],
                               &by_support_[std::min<std::size_t>(p.neighbours, 7) * kSupports + p.support]};
    bool nonzero = residual[j] != 0;
    CodeBin(coder, contexts, j, 0, nonzero);
    std::int64_t steps = 0;
    if (nonzero) {
      const std::int64_t lean = p.relaxed[axis] - 16 * expected;
      bool negative = residual[j] < 0;
      coder.Bit(signs_[2 * Class(std::abs(lean), p.step) + (lean < 0 ? 1 : 0)], negative);
      const auto wanted = static_cast<std::uint32_t>(std::abs(residual[j]));
      std::uint32_t magnitude = CodeUnary<Coder>(
          wanted, kUnary, [&](std::size_t bin, bool& more) { CodeBin(coder, contexts, j, bin, more); });
      if (magnitude > kUnary) {
        std::uint32_t rest = wanted - magnitude;  // a decoder overwrites this value by what it reads
        CodeUnsigned(coder, rest_, rest);
        if (rest >> bits != 0) return false;
        magnitude += rest;
      }
      steps = negative ? -static_cast<std::int64_t>(magnitude) : magnitude;
    }
    residual[j] = static_cast<std::int32_t>(steps);
    const std::int64_t at = expected + steps * p.step;
    if (at < 0 || at >= std::int64_t{1} << bits) return false;
    position[axis] = static_cast<std::uint32_t>(at);
    offset[j] = 16 * at - p.centre[axis];
    before = j == 0 ? std::abs(offset[0]) : (std::abs(offset[0]) + std::abs(offset[1])) / 2;
  }
  return coder.ok();
}

template class PositionCoder<RecordedBins>;
template class PositionCoder<RangeDecoder>;

Status DecodePositions(RangeDecoder& range, const PositionGraph& graph, const PositionSteps& steps, int bits,
                       std::vector<GridPosition>& positions, RecordedBins* bins) {
  PositionPredictor predictor(graph, steps, bits);
  PositionCoder<RangeDecoder> coder;
  PositionCoder<RecordedBins> recorder;
  positions.resize(graph.vertices());
  for (const std::uint32_t v : graph.CodingOrder()) {
    PositionResidual residual = {};
    predictor.Predict(v);
    if (!coder.Code(range, predictor, bits, residual, positions[v])) {
      return Status::Corrupt("I-frame: a position off the grid");
    }
    if (bins) recorder.Code(*bins, predictor, bits, residual, positions[v]);
    predictor.Learn(positions[v]);
  }
  return Status::Ok();
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
// The positions of the I-frame: any code, on a mesh out of the input. What is decoded is then coded and must come back.
#include <algorithm>
#include <vector>

#include "codec/position_coder.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace sac;

// Positions in their coding order, through the same body as the decoder's.
std::vector<std::uint8_t> Encode(const PositionGraph& graph, const PositionSteps& steps, int bits,
                                 const std::vector<GridPosition>& positions) {
  RecordedBins bins;
  PositionPredictor predictor(graph, steps, bits);
  PositionCoder<RecordedBins> coder;
  for (const std::uint32_t v : graph.CodingOrder()) {
    predictor.Predict(v);
    const PositionPredictor::Prediction& p = predictor.now();
    PositionResidual residual;
    PositionPredictor::Vector offset = {};
    for (std::size_t j = 0; j < 3; ++j) {
      const std::int64_t at = positions[v][p.axes[j]], miss = at - predictor.Expected(j, offset);
      FUZZ_REQUIRE(miss % p.step == 0);
      residual[j] = static_cast<std::int32_t>(miss / p.step);
      offset[j] = 16 * at - p.centre[p.axes[j]];
    }
    GridPosition coded;
    FUZZ_REQUIRE(coder.Code(bins, predictor, bits, residual, coded));
    FUZZ_REQUIRE(coded == positions[v]);
    predictor.Learn(coded);
  }
  RangeEncoder range;
  bins.WriteTo(range);
  return range.Finish();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Choices in(std::span(data, size));
  const int bits = 1 + static_cast<int>(in.Below(24));
  const PositionSteps steps{in.U32() >> in.Below(32), in.U32() >> in.Below(32)};
  const std::uint32_t vertices = 1 + in.Below(200);
  std::vector<Triangle> triangles(in.Below(255));
  const std::uint32_t spread = 1 + in.U8();  // few vertices make hubs, near ones make surfaces
  for (std::uint32_t j = 0; j < triangles.size(); ++j) {
    for (std::uint32_t& v : triangles[j]) v = (j * vertices / 255 + in.Below(spread)) % vertices;
  }
  const PositionGraph graph(vertices, triangles);
  std::vector<GridPosition> positions;
  RangeDecoder range(in.rest());
  const Status status = DecodePositions(range, graph, steps, bits, positions);
  if (!status.ok()) return 0;
  FUZZ_REQUIRE(positions.size() == vertices);
  for (const GridPosition& p : positions) FUZZ_REQUIRE(*std::max_element(p.begin(), p.end()) >> bits == 0);

  const std::vector<std::uint8_t> again = Encode(graph, steps, bits, positions);
  std::vector<GridPosition> back;
  RangeDecoder range_again(again);
  FUZZ_REQUIRE(DecodePositions(range_again, graph, steps, bits, back).ok() && range_again.AtEnd());
  FUZZ_REQUIRE(back == positions);
  return 0;
}

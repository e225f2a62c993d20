// SPDX-License-Identifier: Apache-2.0
// Runs the worked examples of spec.md 5.5 and 5.6.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "codec/position_coder.h"
#include "codec/vertex_copies.h"
#include "format/range_coder.h"
#include "format/recorded_bins.h"
#include "tests/spec_examples.h"

namespace sac {
namespace {

TEST(Spec, Positions) {
  const auto settings = Row<std::uint32_t>("positions", "bits-step-slope");
  ASSERT_EQ(settings.size(), 3u);
  const int bits = static_cast<int>(settings[0]);
  std::vector<Triangle> triangles;
  for (const auto& t : Rows<std::uint32_t>("positions", "triangle")) triangles.push_back({t.at(0), t.at(1), t.at(2)});
  const PositionGraph graph(6, triangles);
  PositionPredictor predictor(graph, {settings[1], settings[2]}, bits);
  PositionCoder<RecordedBins> coder;
  RecordedBins bins;
  std::ostringstream told;
  const auto write = [&](const char* name, const auto& numbers) {
    told << name;
    for (const auto x : numbers) told << ' ' << x;
  };
  const Lines lines(Example("positions").begin() + 1 + static_cast<std::ptrdiff_t>(triangles.size()),
                    Example("positions").end());
  std::size_t next = 0;
  for (const std::uint32_t v : graph.CodingOrder()) {
    predictor.Predict(v);
    const PositionPredictor::Prediction& p = predictor.now();
    PositionResidual residual;
    const auto words = Words(lines.at(next++));
    for (std::size_t j = 0; j < 3; ++j) residual[j] = std::stoi(words.at(13 + j));
    GridPosition position;
    ASSERT_TRUE(coder.Code(bins, predictor, bits, residual, position));
    predictor.Learn(position);
    told << "vertex " << v << " step " << p.step;
    write(" relaxed", p.relaxed);
    write(" centre", p.centre);
    write(" residual", residual);
    write(" position", position);
    told << '\n';
  }
  RangeEncoder range;
  bins.WriteTo(range);
  told << "bytes " << Hex(range.Finish()) << '\n';
  std::string wanted;
  for (const std::string& line : lines) wanted += line + '\n';
  EXPECT_EQ(told.str(), wanted);
}

TEST(Spec, Copies) {
  std::vector<Triangle> triangles, copies;
  for (const std::string& line : Example("copies")) {
    const auto words = Words(line);
    if (words.at(0) != "triangle") continue;
    const auto number = [&](std::size_t i) { return static_cast<std::uint32_t>(std::stoul(words.at(i))); };
    triangles.push_back({number(1), number(2), number(3)});
    copies.push_back({number(5), number(6), number(7)});
  }
  const CornerKinds kinds = KindsOfCorners(triangles, 0, {}, 6);
  RecordedBins bins;
  ASSERT_TRUE(CopyCoder<RecordedBins>(6, triangles, kinds).Code(bins, 18, copies));
  RangeEncoder range;
  bins.WriteTo(range);
  EXPECT_EQ("bytes " + Hex(range.Finish()), Example("copies").back());
}

}  // namespace
}  // namespace sac

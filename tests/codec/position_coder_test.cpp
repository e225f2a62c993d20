// SPDX-License-Identifier: Apache-2.0
#include "codec/position_coder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "codec/encode/position_search.h"
#include "format/range_coder.h"
#include "format/recorded_bins.h"

namespace sac {
namespace {

using Cells = std::vector<std::array<double, 3>>;

// A sheet of `side` x `side` vertices.
std::vector<Triangle> SheetTriangles(std::uint32_t side) {
  std::vector<Triangle> triangles;
  for (std::uint32_t y = 0; y + 1 < side; ++y) {
    for (std::uint32_t x = 0; x + 1 < side; ++x) {
      const std::uint32_t a = y * side + x;
      triangles.push_back({a, a + 1, a + side});
      triangles.push_back({a + 1, a + side + 1, a + side});
    }
  }
  return triangles;
}

std::vector<std::uint8_t> Bytes(const RecordedBins& bins) {
  RangeEncoder range;
  bins.WriteTo(range);
  return range.Finish();
}

// Decodes a code of nothing but positions.
Status Decode(const std::vector<std::uint8_t>& bytes, const PositionGraph& graph, const PositionSteps& steps, int bits,
              std::vector<GridPosition>& positions) {
  RangeDecoder range(bytes);
  RecordedBins again;
  SAC_RETURN_IF_ERROR(DecodePositions(range, graph, steps, bits, positions, &again));
  if (!range.AtEnd()) return Status::Corrupt("wrong length");
  EXPECT_EQ(Bytes(again), bytes);
  return Status::Ok();
}

std::vector<GridPosition> Decoded(const RecordedBins& bins, const PositionGraph& graph, const PositionSteps& steps,
                                  int bits) {
  std::vector<GridPosition> positions;
  const Status status = Decode(Bytes(bins), graph, steps, bits, positions);
  EXPECT_TRUE(status.ok()) << status.message();
  return positions;
}

// Largest distance along an axis.
double MaxOff(const Cells& cells, const std::vector<GridPosition>& positions) {
  double off = 0;
  for (std::size_t v = 0; v < cells.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) off = std::max(off, std::abs(cells[v][a] - positions[v][a]));
  }
  return off;
}

TEST(PositionPredictor, IsExactOnARegularSheet) {
  const std::uint32_t side = 12;
  const PositionGraph graph(side * side, SheetTriangles(side));
  PositionPredictor predictor(graph, {16, 0}, 12);
  for (const std::uint32_t v : graph.CodingOrder()) {
    const std::uint32_t x = v % side, y = v / side;
    const GridPosition truth = {500 + 7 * x + 3 * y, 900 - 11 * x + 5 * y, 40 + 13 * y};
    predictor.Predict(v);
    if (predictor.now().support > 0) {
      EXPECT_EQ(predictor.now().disagreement, 0);
      for (std::size_t a = 0; a < 3; ++a)
        EXPECT_NEAR(predictor.now().centre[a] / 16.0, truth[a], predictor.now().support > 1 ? 4 : 16) << v;
    }
    predictor.Learn(truth);
  }
}

TEST(PositionPredictor, KnowsTheSurface) {
  // A sheet at 45 degrees: what is off along the first axes is expected along the last.
  const PositionGraph graph(4, std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}});
  PositionPredictor predictor(graph, {16, 0}, 12);
  const std::vector<GridPosition> sheet = {{100, 200, 100}, {200, 200, 200}, {100, 100, 100}};
  for (std::uint32_t v = 0; v < 3; ++v) {
    predictor.Predict(v);
    predictor.Learn(sheet[v]);
  }
  predictor.Predict(3);
  ASSERT_EQ(predictor.now().support, 1u);
  EXPECT_EQ(predictor.now().axes, (std::array<std::size_t, 3>{1, 0, 2}));  // y is in the sheet, x and z are alike
  const std::int64_t z = predictor.Expected(2, {});
  EXPECT_EQ(predictor.Expected(2, {0, 16 * 20, 0}), z + 10);  // x + 20 is z + 20, of which it trusts half
  EXPECT_EQ(predictor.Expected(2, {16 * 20, 0, 0}), z);
}

TEST(Positions, ComeBackWithinTheirSteps) {
  std::mt19937 random(1);
  for (const int bits : {1, 7, 12, 24}) {
    for (const PositionSteps steps : {PositionSteps{16, 0}, {100, 0}, {0, 400}, {40, 1000}}) {
      const std::uint32_t side = 9;
      Cells cells;
      for (std::uint32_t v = 0; v < side * side; ++v) {
        const double x = v % side, y = v / side, scale = std::ldexp(1.0, bits) / 10;
        cells.push_back(
            {scale * x, scale * y, scale * (1 + std::sin(x)) + scale * 1e-9 * static_cast<double>(random())});
        for (double& c : cells.back()) c = std::clamp(c, 0.0, std::ldexp(1.0, bits) - 1);
      }
      const PositionGraph graph(side * side, SheetTriangles(side));
      const auto positions = Decoded(EncodePositions(cells, graph, steps, bits), graph, steps, bits);
      ASSERT_EQ(positions.size(), cells.size());
      const double longest = 16 * 4 * std::ldexp(1.0, bits) / 10;
      const double largest = std::max(1.0, (steps.base + steps.slope * longest / 4096) / 16);
      // One step for the choice, a bit more because a neighbour's error is followed.
      EXPECT_LE(MaxOff(cells, positions), 2 * largest) << bits << ' ' << steps.base << ' ' << steps.slope;
    }
  }
}

TEST(Positions, OfAnyTriangles) {
  std::mt19937 random(2);
  for (int round = 0; round < 50; ++round) {
    const auto vertices = static_cast<std::uint32_t>(1 + random() % 60);
    std::vector<Triangle> triangles(random() % 200);
    for (Triangle& t : triangles) {
      for (std::uint32_t& v : t) v = random() % 3 == 0 ? 0 : static_cast<std::uint32_t>(random() % vertices);
    }
    const int bits = 1 + static_cast<int>(random() % 24);
    Cells cells(vertices);
    for (auto& c : cells) {
      for (double& x : c) x = static_cast<double>(random() % (1u << bits));
    }
    const PositionGraph graph(vertices, triangles);
    const PositionSteps one{1, 0};  // every cell can be reached
    EXPECT_LE(MaxOff(cells, Decoded(EncodePositions(cells, graph, one, bits), graph, one, bits)), 2);
  }
}

TEST(Positions, EdgesKeepTheirLengthsBetterThanByRounding) {
  const std::uint32_t side = 30;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-3, 3);
  Cells cells;
  for (std::uint32_t v = 0; v < side * side; ++v) {
    cells.push_back(
        {100 + 16.0 * (v % side) + noise(random), 100 + 16.0 * (v / side) + noise(random), 100 + noise(random)});
  }
  const auto triangles = SheetTriangles(side);
  const PositionGraph graph(side * side, triangles);
  const PositionSteps steps{64, 0};
  const auto positions = Decoded(EncodePositions(cells, graph, steps, 10), graph, steps, 10);
  double chosen = 0, rounded = 0;
  const auto distance = [](const auto& a, const auto& b) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = static_cast<double>(a[k]) - static_cast<double>(b[k]);
      sum += d * d;
    }
    return std::sqrt(sum);
  };
  const auto round = [](std::array<double, 3> p) {
    for (double& x : p) x = 4 * std::round(x / 4);
    return p;
  };
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const double length = distance(cells[a], cells[b]);
      chosen += std::pow(distance(positions[a], positions[b]) - length, 2);
      rounded += std::pow(distance(round(cells[a]), round(cells[b])) - length, 2);
    }
  }
  EXPECT_LT(chosen, 0.7 * rounded);
}

TEST(Positions, StepsFollowTheEdges) {
  // Two sheets, one 16 times as large as the other.
  const std::uint32_t side = 8, n = side * side;
  Cells cells;
  std::vector<Triangle> triangles = SheetTriangles(side);
  for (std::uint32_t i = 0; i < 2 * n; ++i) {
    const double scale = i < n ? 32 : 512;
    cells.push_back({scale * (i % side) + 0.37 * i, scale * (i % n / side), 0.61 * i});
  }
  for (const Triangle& t : SheetTriangles(side)) triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  const PositionGraph graph(2 * n, triangles);
  const PositionSteps steps{0, 512};  // an eighth of an edge
  const auto positions = Decoded(EncodePositions(cells, graph, steps, 13), graph, steps, 13);
  const Cells small(cells.begin(), cells.begin() + n), large(cells.begin() + n, cells.end());
  const double off_small = MaxOff(small, {positions.begin(), positions.begin() + n});
  const double off_large = MaxOff(large, {positions.begin() + n, positions.end()});
  EXPECT_LE(off_small, 8);
  EXPECT_GT(off_large, 16);
  EXPECT_LE(off_large, 2 * 128);
}

TEST(Positions, MalformedCodesAreRefused) {
  const std::uint32_t side = 5;
  const PositionGraph graph(side * side, SheetTriangles(side));
  Cells cells;
  for (std::uint32_t v = 0; v < side * side; ++v) cells.push_back({3.0 * (v % side), 3.0 * (v / side), v % 3 * 1.0});
  const PositionSteps steps{16, 0};
  const std::vector<std::uint8_t> good = Bytes(EncodePositions(cells, graph, steps, 4));
  std::vector<GridPosition> positions;
  EXPECT_TRUE(Decode(good, graph, steps, 4, positions).ok());
  std::vector<std::uint8_t> longer = good;
  longer.insert(longer.end(), {1, 2, 3, 4, 5});
  EXPECT_EQ(Decode(longer, graph, steps, 4, positions).code(), StatusCode::kCorrupt);
  EXPECT_EQ(Decode(good, graph, {160, 0}, 4, positions).code(), StatusCode::kCorrupt);  // off the grid
  EXPECT_EQ(Decode({}, graph, steps, 4, positions).code(), StatusCode::kCorrupt);
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/position_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "codec/position_coder.h"

namespace sac {
namespace {

using Point = std::array<double, 3>;

// Weights found by experiment (docs/decisions.md). Errors are counted in steps, rates in bits.
// The share of its neighbours' mean error that a vertex follows: vertices with equal errors keep the edges between
// them.
constexpr double kFollow = 0.65;
constexpr double kPlace = 0.15;        // weight of the squared error of the position; edge lengths have weight 1
constexpr double kRate = 0.05 * 1.44;  // weight of the estimated code length, by a Laplace distribution

double Length(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

class Search {
 public:
  Search(std::span<const Point> cells, const PositionGraph& graph, const PositionPredictor& predictor, int bits)
      : cells_(cells),
        graph_(graph),
        predictor_(predictor),
        last_(std::ldexp(1.0, bits) - 1),
        coded_(cells.size()),
        placed_(cells.size(), false) {}

  // The best residual of the vertex predicted last. On each axis the two values around the target are tried.
  PositionResidual Choose() {
    const PositionPredictor::Prediction& p = predictor_.now();
    known_.clear();
    target_ = cells_[p.vertex];
    Point drift = {};
    for (const std::uint32_t w : graph_.Neighbors(p.vertex)) {
      if (!placed_[w]) continue;
      known_.push_back(w);
      for (std::size_t a = 0; a < 3; ++a) drift[a] += coded_[w][a] - cells_[w][a];
    }
    for (std::size_t a = 0; a < 3; ++a) {
      if (!known_.empty()) target_[a] += kFollow * drift[a] / static_cast<double>(known_.size());
      target_[a] = std::clamp(target_[a], 0.0, last_);
    }
    best_cost_ = std::numeric_limits<double>::infinity();
    Try(0, {}, {}, {}, 0);
    return best_;
  }
  void Place(const GridPosition& position) {
    Point& p = coded_[predictor_.now().vertex];
    for (std::size_t a = 0; a < 3; ++a) p[a] = position[a];
    placed_[predictor_.now().vertex] = true;
  }

 private:
  void Try(std::size_t j, PositionResidual residual, PositionPredictor::Vector offset, Point point, double rate) {
    const PositionPredictor::Prediction& p = predictor_.now();
    const auto step = static_cast<double>(p.step);
    if (j == 3) {
      const double cost = Cost(point) / (step * step) + kRate * rate;
      if (cost >= best_cost_) return;
      best_cost_ = cost;
      best_ = residual;
      return;
    }
    const std::size_t axis = p.axes[j];
    const std::int64_t expected = predictor_.Expected(j, offset);
    const double low = std::floor((target_[axis] - static_cast<double>(expected)) / step);
    for (const double steps : {low, low + 1}) {
      const std::int64_t at = expected + static_cast<std::int64_t>(steps) * p.step;
      if (at < 0 || static_cast<double>(at) > last_) continue;
      residual[j] = static_cast<std::int32_t>(steps);
      offset[j] = 16 * at - p.centre[axis];
      point[axis] = static_cast<double>(at);
      const double scale = std::max(static_cast<double>(p.near_miss) / 16, 0.5 * step);
      Try(j + 1, residual, offset, point, rate + std::abs(steps) * step / scale);
    }
  }
  double Cost(const Point& point) const {
    const std::uint32_t v = predictor_.now().vertex;
    double edges = 0;
    for (const std::uint32_t w : known_) {
      const double change = Length(point, coded_[w]) - Length(cells_[v], cells_[w]);
      edges += change * change;
    }
    const double off = Length(point, target_);
    return (known_.empty() ? 0 : edges / static_cast<double>(known_.size())) + kPlace * off * off;
  }

  std::span<const Point> cells_;
  const PositionGraph& graph_;
  const PositionPredictor& predictor_;
  double last_;
  std::vector<Point> coded_;
  std::vector<bool> placed_;
  std::vector<std::uint32_t> known_;
  Point target_;
  PositionResidual best_;
  double best_cost_;
};

}  // namespace

RecordedBins EncodePositions(std::span<const std::array<double, 3>> cells, const PositionGraph& graph,
                             const PositionSteps& steps, int bits) {
  PositionPredictor predictor(graph, steps, bits);
  PositionCoder<RecordedBins> coder;
  RecordedBins bins;
  Search search(cells, graph, predictor, bits);
  for (const std::uint32_t v : graph.CodingOrder()) {
    predictor.Predict(v);
    PositionResidual residual = search.Choose();
    GridPosition position;
    coder.Code(bins, predictor, bits, residual, position);
    predictor.Learn(position);
    search.Place(position);
  }
  return bins;
}

}  // namespace sac

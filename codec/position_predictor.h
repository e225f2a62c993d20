// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/position_graph.h"
#include "format/grid_position.h"

namespace sac {

// How finely positions are coded (spec.md 5.5.5). The step of a vertex is base + slope * mean length of the edges near
// it, because an error is visible, and counts in STED, in proportion to the lengths of edges.
struct PositionSteps {
  std::uint32_t base = 16;  // 1/16 of a grid cell
  std::uint32_t slope = 0;  // 1/4096 of the length
};

// Predicts the vertices of the I-frame one after another from the vertices before and the triangles (spec.md 5.5). Its
// weights adapt after each vertex. All computation is in integers. Lengths are in 1/16 of a grid cell.
class PositionPredictor {
 public:
  using Vector = std::array<std::int64_t, 3>;
  static constexpr std::size_t kSupports = 5;  // classes of the number of parallelograms

  // The prediction of a vertex and what its contexts are chosen by.
  struct Prediction {
    std::uint32_t vertex = 0;
    Vector centre = {};               // predicted position, 1/16 of a cell
    std::int64_t step = 1;            // cells
    std::array<std::size_t, 3> axes;  // in coding order; the axis nearest to the surface normal is last
    std::size_t neighbours = 0;       // neighbours with known positions
    std::size_t support = 0;          // parallelograms, kSupports - 1 for more
    std::int64_t disagreement = 0;    // mean distance of the parallelograms' corners from their mean, per axis
    std::int64_t near_miss = 0;       // mean prediction error of the known neighbours
    std::int64_t far_miss = 0;        // mean prediction error of the known neighbours' known neighbours
    Vector relaxed = {};              // the position where the surface bends least (spec.md 5.5.4)
  };

  // `graph` must outlive the object. Positions have `bits` bits per axis.
  PositionPredictor(const PositionGraph& graph, const PositionSteps& steps, int bits);

  // Predicts `vertex`, whose position must not have been learnt.
  void Predict(std::uint32_t vertex);
  // The result of the last Predict().
  const Prediction& now() const { return now_; }
  // The expected coordinate on axis axes[j], in cells. `offset` has the differences from `centre`, 1/16 of a cell, on
  // the axes coded before.
  std::int64_t Expected(std::size_t j, const Vector& offset) const;
  // Takes the position, in cells, of the vertex predicted last and adapts the weights. The position must be on the
  // grid.
  void Learn(const GridPosition& position);

 private:
  static constexpr std::size_t kMaxGuesses = 24;
  // One unknown vertex of Relax() as (constant + sum of factors * guesses) / denominator.
  struct Equation {
    Vector constant = {};
    std::array<std::int64_t, kMaxGuesses> factors = {};
    std::int64_t denominator = 0;
  };
  // The index of a vertex among the unknown vertices of a prediction.
  struct Slot {
    std::uint32_t prediction = 0;  // 1 + the predicted vertex that the index belongs to; 0: none
    std::uint32_t index = 0;
  };

  bool Given(std::uint32_t v) const { return known_[v] || slot_[v].prediction == now_.vertex + 1; }
  void AverageNeighbors();
  void AddParallelograms();
  void GatherUnknown();
  Equation EquationOf(std::uint32_t u) const;
  Vector Relax();
  std::int64_t Along(const Vector& offset) const;

  const PositionGraph& graph_;
  PositionSteps steps_;
  std::vector<Vector> positions_;  // 1/16 of a cell
  std::vector<bool> known_;
  std::vector<Slot> slot_;
  std::vector<std::int64_t> misses_;       // prediction error of each known vertex, mean over the axes
  std::int64_t last_cell_;                 // largest coordinate of the grid, cells
  std::array<Vector, kSupports> weights_;  // by support, 1/65536
  std::int64_t tangent_weight_ = 1 << 15;  // 1/65536
  std::int64_t length_ = 0;                // mean length of the edges near the predicted vertex
  Vector last_;                            // position learnt last

  Prediction now_;
  std::vector<std::uint32_t> known_neighbors_, unknown_;
  Vector parallelogram_, mean_, wide_mean_;
  Vector* weights_now_ = nullptr;
  std::array<Vector, 3> features_;  // by axis, the three differences that the weights multiply
  Vector normal_;                   // 1/1024
};

}  // namespace sac

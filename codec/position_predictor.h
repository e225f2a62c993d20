// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "codec/position_graph.h"
#include "format/grid_position.h"

namespace sac {

// How finely positions are coded: a vertex's step is base + slope * the length of edges near it, because an error is
// seen, and measured by STED, in proportion to the edges (spec.md 5.5.5).
struct PositionSteps {
  std::uint32_t base = 16;  // 1/16 of a grid cell
  std::uint32_t slope = 0;  // 1/4096
};

// Predicts the vertices of the I-frame one after another from those before and the mesh's triangles (spec.md 5.5). It
// learns as it goes; integers alone. Lengths are in 1/16 of a grid cell.
class PositionPredictor {
 public:
  using Vector = std::array<std::int64_t, 3>;

  // What is known of a vertex before its position.
  struct Prediction {
    std::uint32_t vertex = 0;
    Vector centre = {};               // 1/16 of a cell
    std::int64_t step = 1;            // cells
    std::array<std::size_t, 3> axes;  // in coding order: the one that says most about the surface is last
    std::size_t neighbours = 0;       // known ones
    std::size_t parallelograms = 0;
    std::int64_t spread = 0;       // how far parallelograms disagree
    std::int64_t activity = 0;     // how far off the neighbours were
    std::int64_t surrounding = 0;  // and those around them
    Vector relaxed = {};           // a second opinion
  };

  // `graph` must outlive it. Positions have `bits` bits.
  PositionPredictor(const PositionGraph& graph, const PositionSteps& steps, int bits);

  void Predict(std::uint32_t vertex);
  // What the last call found.
  const Prediction& now() const { return now_; }
  // Where the vertex is expected on axis axes[j], given how far it was from `centre` on the axes before it. Cells.
  std::int64_t Expected(std::size_t j, const Vector& offset) const;
  // The position of the vertex predicted last, which must be on the grid.
  void Learn(const GridPosition& position);

 private:
  static constexpr std::size_t kMaxGuesses = 24;
  struct Equation {
    Vector constant = {};
    std::array<std::int64_t, kMaxGuesses> factors = {};
    std::int64_t denominator = 0;
  };
  // Where a vertex stands among the unknown ones of a prediction.
  struct Slot {
    std::uint32_t prediction = 0;  // 1 + the vertex predicted
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
  std::vector<std::int64_t> misses_;
  std::int64_t last_cell_;                 // of the grid
  std::array<Vector, 40> weights_;         // by class of vertices, 1/65536
  std::int64_t tangent_weight_ = 1 << 15;  // 1/65536
  std::int64_t length_ = 0;                // of the edges near the last vertex
  Vector last_;

  Prediction now_;
  std::vector<std::uint32_t> known_neighbors_, unknown_;
  Vector parallelogram_, mean_, wide_mean_;
  Vector* weights_now_ = nullptr;
  std::array<Vector, 3> features_;  // by axis, what the weights weigh
  Vector normal_;                   // 1/1024
};

}  // namespace sac

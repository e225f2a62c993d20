// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sac/mesh.h"

namespace sac::bench {

// Predicts integer vectors at vertices from those of neighbours, in an order that walks over the surface: the mean of
// the parallelograms a + b - c over triangles (a, b, c) whose edge (a, b) faces the vertex; where there is none, the
// mean of the neighbours that are known; at the first vertex of a component, zero.
class NeighbourPrediction {
 public:
  NeighbourPrediction(const std::vector<Triangle>& triangles, std::size_t vertices, std::size_t channels);

  // The i-th vertex of that order.
  std::uint32_t vertex(std::size_t i) const { return order_[i]; }

  // The prediction for the i-th vertex. The values of the vertices before it must be set.
  const std::vector<int>& Predict(std::size_t i);
  void Set(std::size_t i, const std::vector<int>& value);

 private:
  void Walk();

  const std::vector<Triangle>& triangles_;
  std::vector<std::vector<std::uint32_t>> around_;  // the triangles around each vertex
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> rank_;  // the place of each vertex in the order
  std::vector<std::vector<int>> values_;
  std::vector<int> predicted_;
};

}  // namespace sac::bench

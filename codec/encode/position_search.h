// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/position_graph.h"
#include "codec/position_predictor.h"

namespace sac {

// Chooses and codes positions for the vertices of `graph`, whose own are `cells`, on a grid of `bits` bits: near
// enough, cheap, and above all such that edges keep their lengths. Errors of up to a step along each axis.
std::vector<std::uint8_t> EncodePositions(std::span<const std::array<double, 3>> cells, const PositionGraph& graph,
                                          const PositionSteps& steps, int bits);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/position_graph.h"
#include "codec/position_predictor.h"
#include "format/recorded_bins.h"

namespace sac {

// Chooses positions near `cells` for the vertices of `graph`, on a grid of `bits` bits per axis, and returns the
// bins of their code. `cells` has the exact positions in cells. The choice minimizes the changes of edge lengths, the
// errors of positions and the estimated bits. On each axis it is one of the two codable coordinates around a target,
// which is the exact position shifted by a part of the neighbours' error (non-normative).
RecordedBins EncodePositions(std::span<const std::array<double, 3>> cells, const PositionGraph& graph,
                             const PositionSteps& steps, int bits);

}  // namespace sac

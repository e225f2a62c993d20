// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <span>

#include "format/grid_position.h"

namespace sac {

// Computes smooth functions on a component's vertices that sum to one at each vertex. They span the reduced harmonic
// basis (spec.md 6.4.4). `functions` gets one row per vertex and one column per sample. The samples are vertices found
// by farthest-point sampling with integer distances on the position grid, so that every decoder finds the same ones.
// `functions` gets no columns when there are fewer different positions than `samples`.
//
// Returns false when the matrix would have more than `max_values` nonzero values. A surface has about 20 per vertex,
// vertices that fill a volume have 100 and more.
bool RadialFunctions(std::span<const GridPosition> grid, std::uint32_t samples, double max_values,
                     Eigen::SparseMatrix<double>& functions);

}  // namespace sac

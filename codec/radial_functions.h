// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <span>

#include "format/grid_position.h"

namespace sac {

// Smooth functions on a component's vertices that sum to one at each: the span of a reduced harmonic basis (spec.md
// 6.4.4). One column a sample; the samples are found by farthest-point sampling with integer distances on the position
// grid, so that every decoder finds the same. No columns when there are fewer different positions than samples. False
// when there are more than `max_values`: on a surface some 20 a vertex, where vertices fill a volume 100 and more.
bool RadialFunctions(std::span<const GridPosition> grid, std::uint32_t samples, double max_values,
                     Eigen::SparseMatrix<double>& functions);

}  // namespace sac

#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <span>

namespace sac {

// Smooth functions on a component's vertices that sum to one at each: the span of a reduced harmonic basis (spec.md
// 6.4.4). One column a sample; the samples are found by farthest-point sampling with integer distances on the position
// grid, so that every decoder finds the same. No columns when there are fewer different positions than samples. False
// when there are more than `most_values`: on a surface some 20 a vertex, where vertices fill a volume 100 and more.
bool RadialFunctions(std::span<const std::array<std::uint32_t, 3>> grid, std::uint32_t samples, double most_values,
                     Eigen::SparseMatrix<double>& functions);

}  // namespace sac

#pragma once

#include <cstdint>

namespace sac {

// Of a mesh and what is derived from it but its basis and factor (spec.md 9): bytes at most, about.
constexpr std::uint64_t MeshMemory(std::uint64_t vertices, std::uint64_t triangles) {
  return 500 * vertices + 350 * triangles;
}

// Of a value of a plane: the coefficient, its residual, and a coefficient of the group before.
constexpr std::uint64_t kCoefficientMemory = 12;

}  // namespace sac

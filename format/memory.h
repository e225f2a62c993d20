// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sac {

// The memory of a mesh and of everything derived from it except its basis and its factor, in bytes, as spec.md 9 counts
// it.
constexpr std::uint64_t MeshMemory(std::uint64_t vertices, std::uint64_t copies, std::uint64_t triangles) {
  return 400 * vertices + 100 * copies + 200 * triangles;
}

// The memory of one value of a plane in bytes: its coefficient, its residual, and a coefficient of the group before.
constexpr std::uint64_t kCoefficientMemory = 12;

}  // namespace sac

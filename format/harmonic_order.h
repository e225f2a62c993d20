// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sac {

// One row of a plane: harmonic number `k`, by ascending eigenvalue, of the component or patch `component`.
struct HarmonicIndex {
  std::uint32_t component;
  std::uint32_t k;
};

// The order of a plane's rows: by k / counts[component], then by component (spec.md 6.3). `counts` holds the number of
// harmonics of each component. Only integers decide, so that the meaning of a bit never depends on a float.
std::vector<HarmonicIndex> HarmonicOrder(std::span<const std::uint32_t> counts);

// The class of harmonic number `k` for the contexts, 1..23, in half octaves of k + 1 (spec.md 7.4).
std::uint8_t HarmonicClass(std::uint32_t k);

}  // namespace sac

#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sac {

// One row of a plane: harmonic `k` (by ascending eigenvalue) of component, or patch, `component`.
struct HarmonicIndex {
  std::uint32_t component;
  std::uint32_t k;
};

// The order of a plane's rows, from the number of harmonics per component: by k / count, then
// by component (spec.md 6.3). It is made of integers alone, so that no float decides what a bit means.
std::vector<HarmonicIndex> HarmonicOrder(std::span<const std::uint32_t> counts);

// The class of a harmonic for the contexts, 1..23: in half octaves of k + 1 (spec.md 7.4).
std::uint8_t HarmonicClass(std::uint32_t k);

}  // namespace sac

#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sac {

// One coefficient index of a plane: harmonic `k` (by ascending eigenvalue) of component `component`.
struct HarmonicIndex {
  std::uint32_t component;
  std::uint32_t k;
  std::uint8_t band;  // of the contexts, 0..6
};

// The order in which a plane's coefficients are coded, from the number of harmonics per component: by k / count, then
// by component (spec.md 6.3). It is made of integers alone, so that no float decides what a bit means.
std::vector<HarmonicIndex> HarmonicOrder(std::span<const std::uint32_t> counts);

}  // namespace sac

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace sac {

// spec.md 7.4: the class of an activity a is floor(2 log2(1 + 3 a)), at most 15; here of s = 24 a, by the thresholds
// ceil(8 (2^(c / 2) - 1)) of class c.
inline constexpr std::size_t kActivities = 16;

inline std::size_t ActivityClass(std::int64_t s) {
  constexpr std::array<std::int64_t, kActivities - 1> kThresholds = {4,   8,   15,  24,  38,  56,   83,  120,
                                                                     174, 248, 355, 504, 717, 1016, 1441};
  return static_cast<std::size_t>(std::upper_bound(kThresholds.begin(), kThresholds.end(), s) - kThresholds.begin());
}

}  // namespace sac

#pragma once

#include <functional>

#include "format/status.h"

namespace sac {

// Figures are compared by the logarithm of figure / target. A bound is kept at 0 and below, and met from here on.
inline constexpr double kBandLow = -0.0304;  // 97 %
inline constexpr double kBandAim = -0.0151;  // 98.5 %

inline bool InBand(double y) { return y >= kBandLow && y <= 0; }

// A monotone function of one variable, known by what it costs to evaluate.
struct BandProblem {
  std::function<Status(double x, double& y)> evaluate;
  double slope;      // dy / dx, about
  double low, high;  // of x
  int most_evaluations;
};

// Looks for an x whose y is in the band, beginning with `x`: by secants until there is a bracket, then within it.
// Leaves the last x in `x`, in the band unless the range or the patience ends before.
Status FindInBand(const BandProblem& problem, double& x);

}  // namespace sac

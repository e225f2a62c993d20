// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "rate_control/search_point.h"

namespace sac {

// The largest differences from the table of qualities that a search tries: log_motion and more_bits of SearchPoint.
inline constexpr double kFinestMotion = -1.2, kCoarsestMotion = 1.1, kLeastMoreBits = -2, kMostMoreBits = 2.5;

// Which unknowns of a search may vary beside the quality, and which `part` of their range (0 to 1) they may use.
struct FreePlace {
  bool motion, bits, harmonics;
  double part;
};

// The problem that a proposal solves with predicted figures: to minimize `cost` where `excess` is at most 0. Both are
// logarithms. `excess` grows with the quality if `rises`, otherwise it falls.
struct ProposalProblem {
  std::function<double(const SearchPoint&)> excess, cost;
  bool rises;
  CodingMode mode;
  FreePlace free;
  double quality_reach;  // qualities within this distance of the centre are considered
};

// Returns the best point near `centre`, by pattern search over the free unknowns (Hooke and Jeeves 1961). For each
// point the quality is chosen at which `excess` is 0. When no point has an excess of at most 0, returns the one with
// the least.
SearchPoint Propose(const ProposalProblem& problem, const SearchPoint& centre);

}  // namespace sac

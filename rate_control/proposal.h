// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "rate_control/place.h"

namespace sac {

// How far the unknowns go from the table of qualities.
inline constexpr double kFinestMotion = -1.2, kCoarsestMotion = 1.1, kLeastMoreBits = -2, kMostMoreBits = 2.5;

// The unknowns of a search beside the quality, and how far of their way from the table they may go.
struct FreePlace {
  bool motion, bits, harmonics;
  double part;
};

// What is looked for, by predicted figures: where `excess` is 0 or less, the smallest `cost`. Both are logarithms.
// `excess` falls with the quality, or grows, as `rises` says.
struct ProposalProblem {
  std::function<double(const Place&)> excess, cost;
  bool rises;
  Branch branch;
  FreePlace free;
  double quality_reach;  // how far predictions are trusted
};

// The best place near `centre`, by pattern search (Hooke and Jeeves 1961) over the free unknowns, each with the quality
// at which `excess` is 0. Where there is none, the place of least excess.
Place Propose(const ProposalProblem& problem, const Place& centre);

}  // namespace sac

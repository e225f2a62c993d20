// SPDX-License-Identifier: Apache-2.0
#include "rate_control/proposal.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sac {
namespace {

// An unknown, how far from the centre predictions are trusted (`reach`), and its range.
struct Unknown {
  double SearchPoint::*value;
  double reach, least, most;
};
constexpr std::array<Unknown, 3> kUnknowns = {{{&SearchPoint::log_motion, 0.4, kFinestMotion, kCoarsestMotion},
                                               {&SearchPoint::more_bits, 0.7, kLeastMoreBits, kMostMoreBits},
                                               {&SearchPoint::log_harmonics, 0.25, -0.6, 0.6}}};
constexpr double kPenalty = 1e3;

// Sets the quality of `point`, within [low, high], to the cheapest at which the excess is at most 0, and returns the
// cost. When there is none, returns a penalty that grows with the excess.
double Settle(const ProposalProblem& problem, double low, double high, SearchPoint& point) {
  const double good = problem.rises ? low : high, bad = problem.rises ? high : low;
  point.quality = bad;
  if (problem.excess(point) <= 0) return problem.cost(point);
  point.quality = good;
  if (const double excess = problem.excess(point); excess > 0) return kPenalty * (1 + excess);
  double keeps = good, exceeds = bad;
  for (int i = 0; i < 14; ++i) {
    point.quality = (keeps + exceeds) / 2;
    (problem.excess(point) <= 0 ? keeps : exceeds) = point.quality;
  }
  point.quality = keeps;
  return problem.cost(point);
}

}  // namespace

SearchPoint Propose(const ProposalProblem& problem, const SearchPoint& centre) {
  const double low =
      std::clamp(centre.quality - problem.quality_reach, problem.mode.min_quality, problem.mode.max_quality);
  const double high =
      std::clamp(centre.quality + problem.quality_reach, problem.mode.min_quality, problem.mode.max_quality);
  const std::array<bool, 3> is_free{problem.free.motion, problem.free.bits, problem.free.harmonics};
  SearchPoint best = centre;
  double least = Settle(problem, low, high, best);
  for (double step = 0.5; step > 0.01;) {  // as a fraction of the reach
    bool better = false;
    for (std::size_t u = 0; u < kUnknowns.size(); ++u) {
      if (!is_free[u]) continue;
      const Unknown& unknown = kUnknowns[u];
      const double from = std::max(problem.free.part * unknown.least, centre.*unknown.value - unknown.reach);
      const double to = std::min(problem.free.part * unknown.most, centre.*unknown.value + unknown.reach);
      for (const double direction : {-1.0, 1.0}) {
        SearchPoint point = best;
        point.*unknown.value = std::clamp(best.*unknown.value + direction * step * unknown.reach, from, to);
        const double cost = Settle(problem, low, high, point);
        if (cost >= least - 1e-6) continue;
        least = cost;
        best = point;
        better = true;
      }
    }
    if (!better) step /= 2;
  }
  return best;
}

}  // namespace sac

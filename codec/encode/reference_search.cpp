// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/reference_search.h"

#include <algorithm>
#include <cstddef>

namespace sac {
namespace {

constexpr std::uint32_t kFarthest = 128;  // frames back in coding order
// Pairs are made of the kPaired best single frames; kKept single frames and as many pairs are returned.
constexpr std::size_t kPaired = 5, kKept = 2;

struct Scored {
  double bits;
  References references;
};

void KeepBest(std::vector<Scored>& scored, std::size_t limit) {
  std::stable_sort(scored.begin(), scored.end(), [](const Scored& a, const Scored& b) { return a.bits < b.bits; });
  if (scored.size() > limit) scored.resize(limit);
}

}  // namespace

std::vector<References> LikelyReferences(std::uint32_t coded,
                                         const std::function<double(const References&)>& motion_bits, double limit) {
  const auto score = [&](References references) {
    const double bits = motion_bits(references);
    return Scored{bits, references};
  };
  std::vector<Scored> singles, pairs;
  for (std::uint32_t i = coded - std::min(coded, kFarthest); i < coded; ++i) singles.push_back(score({i}));
  KeepBest(singles, kPaired);
  for (const Scored& a : singles) {
    for (const Scored& b : singles) {
      if (a.references[0] < b.references[0]) pairs.push_back(score({a.references[0], b.references[0]}));
    }
  }
  KeepBest(singles, kKept);
  KeepBest(pairs, kKept);
  std::vector<References> likely;
  for (auto* scored : {&singles, &pairs}) {
    for (Scored& s : *scored) {
      if (s.bits <= limit) likely.push_back(s.references);
    }
  }
  if (motion_bits({}) <= limit) likely.emplace_back();
  return likely;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "format/plane_layout.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace sac {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Pair> Order(const std::vector<std::uint32_t>& counts) {
  std::vector<Pair> order;
  for (const HarmonicIndex& i : HarmonicOrder(counts)) order.emplace_back(i.component, i.k);
  return order;
}

TEST(HarmonicOrder, OfOneComponentIsByEigenvalue) {
  EXPECT_EQ(Order({4}), (std::vector<Pair>{{0, 0}, {0, 1}, {0, 2}, {0, 3}}));
}

TEST(HarmonicOrder, InterleavesComponentsInProportion) {
  // k / count: component 0 at 0, 1/4, 1/2, 3/4; component 1 at 0, 1/2; component 2 at 0.
  EXPECT_EQ(Order({4, 2, 1}), (std::vector<Pair>{{0, 0}, {1, 0}, {2, 0}, {0, 1}, {0, 2}, {1, 1}, {0, 3}}));
  // Equal fractions 1/3 and 2/6 go by component.
  EXPECT_EQ(Order({3, 6}), (std::vector<Pair>{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 2}, {1, 3}, {0, 2}, {1, 4}, {1, 5}}));
}

TEST(HarmonicOrder, NamesEveryHarmonicOnce) {
  const std::vector<std::uint32_t> counts = {1, 700, 1, 33, 2, 33};
  const auto order = Order(counts);
  const std::set<Pair> different(order.begin(), order.end());
  EXPECT_EQ(order.size(), 770u);
  EXPECT_EQ(different.size(), 770u);
  for (const auto& [c, k] : order) EXPECT_LT(k, counts[c]);
}

TEST(HarmonicClass, CountsHalfOctaves) {
  const std::uint32_t k[] = {0, 1, 2, 3, 4, 5, 6, 7, 10, 11, 14, 15, 4094, 4095, 0xfffffffe};
  const int classes[] = {1, 2, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 23, 23, 23};
  for (std::size_t i = 0; i < std::size(k); ++i) EXPECT_EQ(HarmonicClass(k[i]), classes[i]) << k[i];
}

TEST(HarmonicOrder, OfHugeCountsDoesNotOverflow) {
  // 70000 * 69999 is over 32 bits.
  const auto order = Order({70000, 69999});
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    const auto value = [](const Pair& p) { return static_cast<double>(p.second) / (p.first == 0 ? 70000 : 69999); };
    ASSERT_LE(value(order[i]), value(order[i + 1]));
  }
}

}  // namespace
}  // namespace sac

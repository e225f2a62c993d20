// SPDX-License-Identifier: Apache-2.0
#include "format/group.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace sac {
namespace {

TEST(GroupStructure, OfOneFrame) {
  const auto slots = GroupStructure(1, 16);
  ASSERT_EQ(slots.size(), 1u);
  EXPECT_EQ(slots[0].display, 0u);
  EXPECT_EQ(slots[0].level, 0u);
  EXPECT_TRUE(slots[0].references.empty());
}

TEST(GroupStructure, OfAPyramidOfOneIsAChain) {
  const auto slots = GroupStructure(5, 1);
  ASSERT_EQ(slots.size(), 5u);
  for (std::uint32_t i = 1; i < 5; ++i) {
    EXPECT_EQ(slots[i].display, i);
    EXPECT_EQ(slots[i].level, 0u);
    EXPECT_EQ(slots[i].references, References{i - 1});
  }
}

TEST(GroupStructure, OfAPyramidOfFourByHand) {
  // Key frame 0, then 4 from 0, 2 from both, 1 and 3 from their neighbours; then 6, all that is left, from 4, and 5.
  const auto slots = GroupStructure(7, 4);
  ASSERT_EQ(slots.size(), 7u);
  const std::uint32_t display[] = {0, 4, 2, 1, 3, 6, 5}, level[] = {0, 0, 1, 2, 2, 0, 1};
  const References references[] = {{}, {0}, {0, 1}, {0, 2}, {2, 1}, {1}, {1, 5}};
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(slots[i].display, display[i]) << i;
    EXPECT_EQ(slots[i].level, level[i]) << i;
    EXPECT_EQ(slots[i].references, references[i]) << i;
  }
}

TEST(GroupStructure, HalvesDownwards) {
  const auto slots = GroupStructure(4, 16);
  ASSERT_EQ(slots.size(), 4u);
  const std::uint32_t display[] = {0, 3, 1, 2};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(slots[i].display, display[i]) << i;
}

TEST(GroupStructure, ShowsEveryFrameOnceAndLooksBackInCodingOrder) {
  for (const std::uint32_t frames : {1u, 2u, 3u, 16u, 17u, 18u, 100u, 4096u}) {
    for (const std::uint32_t pyramid : {1u, 2u, 3u, 7u, 16u, 4096u, 0xffffffffu}) {
      const auto slots = GroupStructure(frames, pyramid);
      std::set<std::uint32_t> shown;
      for (std::uint32_t i = 0; i < slots.size(); ++i) {
        EXPECT_TRUE(shown.insert(slots[i].display).second);
        EXPECT_LT(slots[i].display, frames);
        EXPECT_EQ(slots[i].references.empty(), i == 0);
        EXPECT_EQ(slots[i].references.size() == 2, slots[i].level > 0);
        for (const std::uint32_t r : slots[i].references) EXPECT_LT(r, i);
        if (slots[i].level > 0) {  // from both sides
          const auto [a, b] = std::minmax(slots[slots[i].references[0]].display, slots[slots[i].references[1]].display);
          EXPECT_LT(a, slots[i].display);
          EXPECT_GT(b, slots[i].display);
        }
      }
      EXPECT_EQ(shown.size(), frames) << pyramid;
    }
  }
}

}  // namespace
}  // namespace sac

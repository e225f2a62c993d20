// SPDX-License-Identifier: Apache-2.0
#include "geometry/components.h"

#include <gtest/gtest.h>

#include <random>

namespace sac {
namespace {

using Labels = std::vector<std::uint32_t>;

Labels Label(std::uint32_t vertices, const std::vector<Triangle>& triangles, std::uint32_t expected) {
  std::uint32_t components = 77;
  const Labels labels = LabelComponents(vertices, triangles, components);
  EXPECT_EQ(components, expected);
  return labels;
}

TEST(Components, OfNothing) {
  EXPECT_TRUE(Label(0, {}, 0).empty());
  EXPECT_EQ(Label(3, {}, 3), Labels({0, 1, 2}));
}

TEST(Components, AreNumberedByTheirSmallestVertex) {
  EXPECT_EQ(Label(8, {{7, 2, 5}, {3, 1, 6}}, 4), Labels({0, 1, 2, 1, 3, 2, 1, 2}));
}

TEST(Components, MeetAtAVertex) { EXPECT_EQ(Label(5, {{0, 1, 2}, {2, 3, 4}}, 1), Labels(5, 0)); }

TEST(Components, CountDegenerateTriangles) {
  EXPECT_EQ(Label(5, {{4, 4, 0}, {2, 2, 2}, {1, 3, 3}}, 3), Labels({0, 1, 2, 1, 0}));
}

TEST(Components, AgreeWithASearch) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const auto n = static_cast<std::uint32_t>(1 + random() % 60);
    std::vector<Triangle> triangles(random() % 25);
    for (Triangle& t : triangles) {
      for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(random() % n);
    }
    // Spread the smallest label along triangles until nothing changes, then number labels as they come.
    Labels smallest(n);
    for (std::uint32_t v = 0; v < n; ++v) smallest[v] = v;
    for (bool changed = true; changed;) {
      changed = false;
      for (const Triangle& t : triangles) {
        const std::uint32_t low = std::min({smallest[t[0]], smallest[t[1]], smallest[t[2]]});
        for (const std::uint32_t v : t) {
          changed = changed || smallest[v] != low;
          smallest[v] = low;
        }
      }
    }
    std::uint32_t components = 0;
    Labels expected(n);
    for (std::uint32_t v = 0; v < n; ++v) expected[v] = smallest[v] == v ? components++ : expected[smallest[v]];
    EXPECT_EQ(Label(n, triangles, components), expected);
  }
}

}  // namespace
}  // namespace sac

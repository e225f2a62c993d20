// SPDX-License-Identifier: Apache-2.0
#include "geometry/coincident_vertices.h"

#include <gtest/gtest.h>

namespace sac {
namespace {

using Numbers = std::vector<std::uint32_t>;

// Vertices on a line at these places.
Positions Line(std::initializer_list<float> places) {
  Positions out;
  for (const float x : places) out.push_back({x, 2, -x});
  return out;
}

TEST(CoincidentVertices, AreThoseOfAllFrames) {
  CoincidentVertices found;
  found.Add(Line({5, 1, 5, 3, 1, 5, 1}));
  EXPECT_TRUE(found.any());
  EXPECT_EQ(found.Lowest(), (Numbers{0, 1, 0, 3, 1, 0, 1}));
  found.Add(Line({5, 1, 5, 5, 1, 6, 1}));  // 3 comes too late, 5 leaves
  EXPECT_EQ(found.Lowest(), (Numbers{0, 1, 0, 3, 1, 5, 1}));
  found.Add(Line({0, 1, 2, 0, 1, 2, 1}));  // 2 meets 5, from which it was apart
  EXPECT_EQ(found.Lowest(), (Numbers{0, 1, 2, 3, 1, 5, 1}));
}

TEST(CoincidentVertices, ThatLeaveTogetherStayTogether) {
  CoincidentVertices found;
  found.Add(Line({7, 7, 7, 7, 7}));
  found.Add(Line({7, 8, 9, 8, 9}));
  EXPECT_EQ(found.Lowest(), (Numbers{0, 1, 2, 1, 2}));
  found.Add(Line({7, 8, 8, 8, 9}));
  EXPECT_EQ(found.Lowest(), (Numbers{0, 1, 2, 1, 4}));
  found.Add(Line({0, 1, 2, 3, 4}));
  EXPECT_FALSE(found.any());
  EXPECT_TRUE(found.Lowest().empty());
}

TEST(CoincidentVertices, AreEqualNumbers) {
  CoincidentVertices found;
  found.Add(Positions{{0.0f, 1, 1}, {-0.0f, 1, 1}, {1e-45f, 1, 1}});
  EXPECT_EQ(found.Lowest(), (Numbers{0, 0, 2}));
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "files/triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace sac {
namespace {

using Points = std::vector<Vec3d>;

// The triangulation of one face of all points in their order.
Triangulation Cut(const Points& points) {
  Faces face;
  face.vertices.resize(points.size());
  std::iota(face.vertices.begin(), face.vertices.end(), 0U);
  face.ends = {static_cast<std::uint32_t>(points.size())};
  return Triangulate(face, points);
}

double Area(const Points& p, const Triangle& t) {
  return ((p[t[1]][0] - p[t[0]][0]) * (p[t[2]][1] - p[t[0]][1]) -
          (p[t[1]][1] - p[t[0]][1]) * (p[t[2]][0] - p[t[0]][0])) /
         2;
}

// The areas of all triangles, each of which is on the side `sign` of the plane z = 0.
double SumOfAreas(const Points& points, const Triangulation& cut, double sign) {
  double sum = 0;
  for (const Triangle& t : cut.corners) {
    EXPECT_GE(sign * Area(points, t), 0);
    sum += sign * Area(points, t);
  }
  return sum;
}

// Checks that triangles fill a face of the plane z = 0, counter-clockwise: none is flipped, together they have its area
// and not more, and every edge of the face is one of a triangle.
void ExpectFilled(const Points& points, double area) {
  const Triangulation cut = Cut(points);
  EXPECT_EQ(cut.overlapping, 0U);
  ASSERT_EQ(cut.corners.size(), points.size() - 2);
  std::vector<bool> edges(points.size());
  for (const Triangle& t : cut.corners) {
    for (int k = 0; k < 3; ++k) {
      if ((t[k] + 1) % points.size() == t[(k + 1) % 3]) edges[t[k]] = true;
    }
  }
  EXPECT_NEAR(SumOfAreas(points, cut, 1), area, 1e-9 * area);
  EXPECT_EQ(std::count(edges.begin(), edges.end(), true), static_cast<std::ptrdiff_t>(points.size()));
}

const Points kL = {{2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}, {0, 0, 0}};

TEST(TriangulationTest, ConvexFacesAreFans) {
  EXPECT_EQ(Cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).corners, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  Points circle;
  for (int k = 0; k < 11; ++k) {
    const double angle = 2 * std::numbers::pi * k / 11;
    circle.push_back({std::cos(angle), std::sin(angle), 1e6});
  }
  const Triangulation cut = Cut(circle);
  for (std::uint32_t k = 0; k < 9; ++k) EXPECT_EQ(cut.corners[k], (Triangle{0, k + 1, k + 2}));
  EXPECT_EQ(cut.polygons, 1U);
  EXPECT_EQ(cut.quads, 0U);
}

TEST(TriangulationTest, ConcaveFacesAreFilledFromEveryCorner) {
  const Points arrow = {{0, 0, 0}, {4, 2, 0}, {0, 4, 0}, {1, 2, 0}};
  Points comb;
  for (int k = 0; k < 6; ++k) {
    comb.push_back({2.0 * k, 0, 0});
    comb.push_back({2.0 * k + 1, k < 5 ? 3.0 : 0, 0});
  }
  comb.push_back({11, 5, 0});
  comb.push_back({0, 5, 0});
  for (const auto& [shape, area] : {std::pair{kL, 3.0}, {arrow, 6.0}, {comb, 40.0}}) {
    Points turned = shape;
    for (std::size_t k = 0; k < shape.size(); ++k) {
      std::rotate(turned.begin(), turned.begin() + 1, turned.end());
      ExpectFilled(turned, area);
    }
  }
}

TEST(TriangulationTest, TheOtherSideIsTheOtherWayRound) {
  Points reversed(kL.rbegin(), kL.rend());
  const Triangulation cut = Cut(reversed);
  EXPECT_EQ(cut.overlapping, 0U);
  EXPECT_NEAR(SumOfAreas(reversed, cut, -1), 3, 1e-9);
}

TEST(TriangulationTest, CollinearAndRepeatedCornersFlipNothing) {
  // A notch whose edges have corners in the middle.
  ExpectFilled({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 2, 0}, {1, 3, 0}, {0, 4, 0}}, 12);
  // A square with a square hole, cut open: two corners come twice.
  const Points keyhole = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                          {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
  const Triangulation cut = Cut(keyhole);
  EXPECT_EQ(cut.overlapping, 0U);
  EXPECT_NEAR(SumOfAreas(keyhole, cut, 1), 12, 1e-9);
  // The same corner twice in a row, as quads that are triangles have it.
  EXPECT_EQ(Cut({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}}).overlapping, 0U);
}

TEST(TriangulationTest, FacesThatAreNotFlatAreFilledInTheirPlane) {
  Points bent = kL;
  for (std::size_t k = 0; k < bent.size(); ++k) bent[k][2] = k % 2 == 0 ? 0.2 : -0.2;
  for (std::size_t k = 0; k < bent.size(); ++k) {
    std::rotate(bent.begin(), bent.begin() + 1, bent.end());
    const Triangulation cut = Cut(bent);
    EXPECT_EQ(cut.overlapping, 0U);
    for (const Triangle& t : cut.corners) EXPECT_GE(Area(bent, t), 0);
  }
}

TEST(TriangulationTest, CrossedFacesStayFansAndAreCounted) {
  const Points bow = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 2, 0}};
  const Triangulation cut = Cut(bow);
  EXPECT_EQ(cut.corners, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(cut.overlapping, 1U);
}

TEST(TriangulationTest, DegenerateFaces) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Cut(Points(5, {1, 2, 3})).corners, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
  EXPECT_EQ(Cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).overlapping, 0U);
  EXPECT_EQ(Cut({{0, 0, 0}, {1, 0, 0}, {kNaN, 0, 0}, {0, 1, 0}}).corners.size(), 2U);
  EXPECT_EQ(Cut({{0, 0, 0}, {1e300, 0, 0}, {1e300, 1e300, 0}, {0, 1e300, 0}}).corners.size(), 2U);
  EXPECT_EQ(Cut({{0, 0, 0}, {1, 0, 0}}).fragments, 1U);
}

}  // namespace
}  // namespace sac

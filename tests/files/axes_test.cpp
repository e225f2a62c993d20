// SPDX-License-Identifier: Apache-2.0
#include "files/axes.h"

#include <gtest/gtest.h>

namespace sac {
namespace {

TEST(AxisConversion, TurnsTheVerticalAxis) {
  AxisConversion to_z, to_y;
  ASSERT_TRUE(to_z.ParseUp("y:z"));
  ASSERT_TRUE(to_y.ParseUp("z:y"));
  const std::array<double, 3> up_of_y{1, 2, 3};
  EXPECT_EQ(to_z.Point(up_of_y), (std::array<double, 3>{1, -3, 2}));  // what was up is the third coordinate
  EXPECT_EQ(to_y.Point(to_z.Point(up_of_y)), up_of_y);
  Mesh mesh;
  mesh.positions = {{1, 2, 3}};
  mesh.normals = {{0, 1, 0}};
  mesh = to_z.Convert(mesh);
  EXPECT_EQ(mesh.positions, (Positions{{1, -3, 2}}));
  EXPECT_EQ(mesh.normals, (std::vector<Vec3f>{{0, 0, 1}}));
}

TEST(AxisConversion, ScalesUnits) {
  AxisConversion conversion;
  EXPECT_FALSE(conversion.changes());
  ASSERT_TRUE(conversion.ParseUnits("in:cm"));
  EXPECT_DOUBLE_EQ(conversion.scale(), 2.54);
  EXPECT_EQ(conversion.Points({{100, 0, -50}}), (Positions{{254, 0, -127}}));
  ASSERT_TRUE(conversion.ParseUnits("km:m"));
  EXPECT_DOUBLE_EQ(conversion.scale(), 1000);
}

TEST(AxisConversion, RefusesOtherWords) {
  AxisConversion conversion;
  for (const char* words : {"", "y", "x:z", "y:y", "Y:Z", "y:z:y"}) EXPECT_FALSE(conversion.ParseUp(words)) << words;
  for (const char* words : {"", "m", "m:", ":m", "m:mile", "1:2"}) EXPECT_FALSE(conversion.ParseUnits(words)) << words;
  EXPECT_FALSE(conversion.changes());
}

}  // namespace
}  // namespace sac

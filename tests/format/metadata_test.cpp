// SPDX-License-Identifier: Apache-2.0
#include "format/metadata.h"

#include <gtest/gtest.h>

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

Metadata Full() {
  Metadata m;
  m.name = "walk";
  m.metres_per_unit = 0.01;
  m.up_axis = 2;
  m.first_frame = -3;
  m.loops = true;
  m.json = "{\"take\": 7}";
  m.bounds = Box{{-1, 0, 2}, {1, 4, 2}};
  m.group_bounds = {InBounds({{-1, 1, 2}, {0, 4, 2}}, *m.bounds), InBounds(*m.bounds, *m.bounds)};
  return m;
}

TEST(Metadata, IsReadAsItWasWritten) {
  Metadata read;
  ASSERT_TRUE(ParseMetadata(WriteMetadata(Full()), read).ok());
  EXPECT_EQ(read.name, "walk");
  EXPECT_EQ(read.metres_per_unit, 0.01);
  EXPECT_EQ(read.up_axis, 2);
  EXPECT_EQ(read.first_frame, -3);
  EXPECT_EQ(read.loops, true);
  EXPECT_EQ(read.json, "{\"take\": 7}");
  EXPECT_EQ(read.bounds->high[1], 4);
  ASSERT_EQ(read.group_bounds.size(), 2u);
  EXPECT_LE(read.GroupBounds(0).low[1], 1);
  EXPECT_GE(read.GroupBounds(0).high[0], 0);
  EXPECT_LT(read.GroupBounds(0).high[0], 0.01);
  EXPECT_TRUE(WriteMetadata({}).empty());
}

TEST(Metadata, APacketReplacesOnlyWhatItHas) {
  Metadata read, later;
  later.name = "run";
  ASSERT_TRUE(ParseMetadata(WriteMetadata(Full()), read).ok());
  ASSERT_TRUE(ParseMetadata(WriteMetadata(later), read).ok());
  EXPECT_EQ(read.name, "run");
  EXPECT_EQ(read.up_axis, 2);
}

TEST(Metadata, UnknownKeysArePassedOver) {
  Bytes bytes = WriteMetadata(Full());
  bytes.insert(bytes.end(), {99, 2, 1, 2});
  Metadata read;
  ASSERT_TRUE(ParseMetadata(bytes, read).ok());
  EXPECT_EQ(read.name, "walk");
}

TEST(Metadata, MalformedPacketsChangeNothing) {
  for (const Bytes& bytes : std::vector<Bytes>{
           {1},                             // no size
           {1, 5, 'a'},                     // shorter than its size
           {2, 1, 0},                       // a unit of one byte
           {2, 8, 0, 0, 0, 0, 0, 0, 0, 0},  // of length 0
           {3, 1, 3},                       // a fourth axis
           {4, 1, 0},                       // a frame number of one byte
           {5, 1, 2},                       // neither 0 nor 1
           {7, 2, 0, 0},                    // bounds of two bytes
           {8, 5, 0, 0, 0, 0, 0},           // not six a group
           {3, 1, 1, 1, 1, 'a'},            // keys that descend
           {1, 1, 'a', 1, 1, 'b'},          // one twice
           {1, 1, 'a', 0x80, 0x00, 0},      // a malformed key
       }) {
    Metadata read = Full();
    EXPECT_FALSE(ParseMetadata(bytes, read).ok());
    EXPECT_EQ(read.name, "walk");
    EXPECT_EQ(read.up_axis, 2);
  }
}

}  // namespace
}  // namespace sac

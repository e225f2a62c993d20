// SPDX-License-Identifier: Apache-2.0
#include "files/frame_rate.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace sac {
namespace {

std::string Text(const FrameRate& rate) {
  return std::to_string(rate.numerator) + "/" + std::to_string(rate.denominator);
}

std::string Parsed(const std::string& text) {
  FrameRate rate;
  return ParseFrameRate(text, rate) ? Text(rate) : "none";
}

TEST(FrameRateTest, Parse) {
  EXPECT_EQ(Parsed("24"), "24/1");
  EXPECT_EQ(Parsed("24.0"), "24/1");
  EXPECT_EQ(Parsed("24.000"), "24/1");
  EXPECT_EQ(Parsed("30000/1001"), "30000/1001");
  EXPECT_EQ(Parsed("50/2"), "25/1");
  EXPECT_EQ(Parsed("1/3"), "1/3");
  EXPECT_EQ(Parsed("12.5"), "25/2");
  EXPECT_EQ(Parsed("0.25"), "1/4");
  EXPECT_EQ(Parsed("4294967295"), "4294967295/1");
}

TEST(FrameRateTest, DecimalsOfBroadcastRates) {
  EXPECT_EQ(Parsed("29.97"), "30000/1001");
  EXPECT_EQ(Parsed("29.970"), "30000/1001");
  EXPECT_EQ(Parsed("29.97003"), "30000/1001");
  EXPECT_EQ(Parsed("23.976"), "24000/1001");
  EXPECT_EQ(Parsed("23.98"), "24000/1001");
  EXPECT_EQ(Parsed("59.94"), "60000/1001");
  EXPECT_EQ(Parsed("119.88"), "120000/1001");
  EXPECT_EQ(Parsed("29.95"), "599/20");
  EXPECT_EQ(Parsed("24.02"), "1201/50");
}

TEST(FrameRateTest, NoFrameRate) {
  for (const char* text : {"",
                           "0",
                           "0.0",
                           "-24",
                           "+24",
                           "24/",
                           "/1",
                           "24/0",
                           "0/1",
                           "24/1/1",
                           "1e3",
                           "24 ",
                           " 24",
                           "2 4",
                           ".5",
                           "24.",
                           "24.-5",
                           "nan",
                           "4294967296",
                           "4294967295.5",
                           "1.0123456789",
                           "24.5.5",
                           "99999999999999999999"}) {
    EXPECT_EQ(Parsed(text), "none") << text;
  }
}

TEST(FrameRateTest, NearestToMeasured) {
  EXPECT_EQ(Text(NearestFrameRate(30)), "30/1");
  EXPECT_EQ(Text(NearestFrameRate(29.970028)), "30000/1001");
  EXPECT_EQ(Text(NearestFrameRate(23.976025)), "24000/1001");
  EXPECT_EQ(Text(NearestFrameRate(12.5000004)), "25/2");
  EXPECT_EQ(Text(NearestFrameRate(17.123)), "17123/1000");
  for (const double none :
       {0.0, -1.0, 1e9, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(NearestFrameRate(none).numerator, 0u) << none;
  }
}

}  // namespace
}  // namespace sac

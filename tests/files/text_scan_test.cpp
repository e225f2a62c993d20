// SPDX-License-Identifier: Apache-2.0
#include "files/text_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sac {
namespace {

double Double(std::string_view word) {
  double value = 12345;
  EXPECT_TRUE(ParseDouble(word, value)) << word;
  return value;
}

TEST(TextScanTest, DoublesAreTheNearest) {
  EXPECT_EQ(Double("5600000.2939"), 5600000.2939);
  EXPECT_EQ(Double("+.5"), 0.5);
  EXPECT_EQ(Double("1e-400"), 0);
  EXPECT_EQ(Double("-1e400"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(Double("1e99"), 1e99);
}

TEST(TextScanTest, RoundingADoubleGivesTheNearestFloat) {
  // Just above and just below the middle of 1 and the next float32; the nearest double is the middle itself.
  const float next = std::nextafter(1.0F, 2.0F);
  EXPECT_EQ(static_cast<float>(Double("1.00000005960464477539062500000001")), next);
  EXPECT_EQ(static_cast<float>(Double("1.000000059604644775390625")), 1.0F);
  EXPECT_EQ(static_cast<float>(Double("-1.00000005960464477539062500000001")), -next);
  // The middle of next and the one after it is rounded up, to even; below it, down.
  EXPECT_EQ(static_cast<float>(Double("1.00000017881393432617187499999999")), next);
}

TEST(TextScanTest, NotFiniteNumbersOfOldLibraries) {
  for (const char* word : {"nan", "-nan(ind)", "1.#IND", "-1.#IND", "1.#QNAN", "1.#QNAN0"}) {
    EXPECT_TRUE(std::isnan(Double(word))) << word;
    float narrow = 0;
    EXPECT_TRUE(ParseFloat(word, narrow) && std::isnan(narrow)) << word;
  }
  EXPECT_EQ(Double("1.#INF"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(Double("-1.#INF00"), -std::numeric_limits<double>::infinity());
  double value = 0;
  for (const char* word : {"", "+", "x", "1.#", "1.#JND", "1x", "0,5", "++1"}) {
    EXPECT_FALSE(ParseDouble(word, value)) << word;
  }
}

TEST(TextScanTest, DecimalCommasAreNamed) {
  EXPECT_EQ(NotANumber("1,5e3").message(), "not a number: 1,5e3 (a decimal comma; export with decimal points)");
  EXPECT_EQ(NotANumber("a,b").message(), "not a number: a,b");
  EXPECT_EQ(NotANumber("1,2,3").message(), "not a number: 1,2,3");
}

TEST(TextScanTest, LinesOfEveryKindBecomeOne) {
  std::string text =
      "\xEF\xBB\xBF"
      "a\rb\r\nc\n\nd\v\f"
      "e\xC2\x85"
      "f\xE2\x80\xA8"
      "g\xE2\x80\xA9"
      "h\xC3\x84\xE2\x82\xAC\r";
  ASSERT_TRUE(NormalizeText(text).ok());
  EXPECT_EQ(text, "a\nb\nc\n\nd\n\ne\nf\ng\nh\xC3\x84\xE2\x82\xAC\n");
  EXPECT_EQ(LineNumber(text, text.find('c')), 3U);
  EXPECT_EQ(LineNumber(text, 0), 1U);
  std::string cut = "a\xE2\x80";
  ASSERT_TRUE(NormalizeText(cut).ok());
  EXPECT_EQ(cut, "a\xE2\x80");
  for (const char* mark : {"\xFF\xFEv", "\xFE\xFFv"}) {
    std::string wide = mark;
    EXPECT_EQ(NormalizeText(wide).message(), "text in UTF-16 or UTF-32; save it as UTF-8");
  }
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "tests/rate_control/rate_table.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace sac {
namespace {

// Other compilers' mathematical functions differ in the last digit, which now and then turns a coefficient.
constexpr double kTolerance = 0.005;

TEST(RateTable, SizesAndErrorsAreWhatTheTableSays) {
  std::ifstream file(SAC_RATE_TABLE);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<RateRow> expected, rows;
  ASSERT_TRUE(ParseRates(text, expected)) << SAC_RATE_TABLE;
  const Status status = MeasureRates(rows);
  ASSERT_TRUE(status.ok()) << status.message();
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RateRow &row = rows[i], &was = expected[i];
    SCOPED_TRACE(was.name + "; where this is meant, cmake --build BUILD --target rate_table writes the table anew");
    EXPECT_EQ(row.name, was.name);
    EXPECT_NEAR(static_cast<double>(row.bytes), static_cast<double>(was.bytes),
                kTolerance * static_cast<double>(was.bytes));
    EXPECT_NEAR(row.kg, was.kg, kTolerance * was.kg);
    EXPECT_NEAR(row.sted, was.sted, kTolerance * was.sted);
  }
}

TEST(RateTable, ComesBackFromItsText) {
  const std::vector<RateRow> rows = {{"flag,600,24,quality 50", 1234, 1.25, 0.0625}, {"a,b,c,d", 1, 0, 3}};
  const std::string text = FormatRates(rows);
  std::vector<RateRow> back;
  ASSERT_TRUE(ParseRates(text, back));
  EXPECT_EQ(FormatRates(back), text);
  for (const std::string& bad : {std::string(), std::string("clip\n"), text + "\n", text + "flag,1,2\n",
                                 text + "flag,1,2,x\n", text + "flag,1,2,3,4\n", text + "flag,1,-2.5,3\n"}) {
    std::vector<RateRow> none;
    EXPECT_FALSE(ParseRates(bad, none)) << bad;
  }
}

}  // namespace
}  // namespace sac

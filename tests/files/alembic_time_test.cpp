// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/alembic_time.h"

#include <gtest/gtest.h>

#include <limits>

namespace sac {
namespace {

void ExpectMoment(const AlembicMoment& moment, std::uint32_t low, std::uint32_t high, double weight) {
  EXPECT_EQ(moment.low, low);
  EXPECT_EQ(moment.high, high);
  EXPECT_NEAR(moment.weight, weight, 1e-9);
}

TEST(AlembicTimeTest, Uniform) {
  const AlembicTimeSampling times{0.25, {1}, false};
  EXPECT_EQ(times.Time(0), 1);
  EXPECT_EQ(times.Time(8), 3);
  EXPECT_EQ(times.Rate(9), 4);
  ExpectMoment(times.At(0, 9), 0, 0, 0);
  ExpectMoment(times.At(1, 9), 0, 0, 0);
  ExpectMoment(times.At(1.3, 9), 1, 2, 0.2);
  ExpectMoment(times.At(1.49999, 9), 2, 2, 0);
  ExpectMoment(times.At(1.50001, 9), 2, 2, 0);
  ExpectMoment(times.At(100, 9), 8, 8, 0);
  ExpectMoment(times.At(1.3, 1), 0, 0, 0);
}

TEST(AlembicTimeTest, SeveralInAPeriod) {
  const AlembicTimeSampling times{1, {-0.25, 0, 0.25}, false};
  EXPECT_EQ(times.Time(4), 1);
  EXPECT_EQ(times.Rate(6), 1);
  ExpectMoment(times.At(0.5, 6), 2, 3, 0.5);
  ExpectMoment(times.At(1.25, 6), 5, 5, 0);
}

TEST(AlembicTimeTest, TheirOwn) {
  const AlembicTimeSampling times{std::numeric_limits<double>::max() / 32, {0, 1, 5}, true};
  EXPECT_EQ(times.Time(2), 5);
  EXPECT_EQ(times.Rate(3), 0.4);
  ExpectMoment(times.At(2, 3), 1, 2, 0.25);
  // Two samples at one time: the later counts.
  const AlembicTimeSampling twice{1, {0, 1, 1, 2}, true};
  ExpectMoment(twice.At(1, 4), 2, 2, 0);
  const AlembicTimeSampling still{1, {3, 3}, true};
  EXPECT_EQ(still.Rate(2), 0);
}

TEST(AlembicTimeTest, ManySamples) {
  const AlembicTimeSampling times{1.0 / 24, {0}, false};
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
  ExpectMoment(times.At(1e30, kMost), kMost - 1, kMost - 1, 0);
  ExpectMoment(times.At(-1e30, kMost), 0, 0, 0);
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "format/integer_coder.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace sac {
namespace {

// Every power of two and its neighbours below 2^31, the ends of what se and ue can say.
std::vector<std::uint32_t> Boundaries() {
  std::vector<std::uint32_t> values = {0};
  for (int i = 0; i < 31; ++i) {
    const std::uint32_t power = 1u << i;
    values.insert(values.end(), {power - 1, power, power + 1});
  }
  values.push_back(0x7ffffffe);
  return values;
}

TEST(UnsignedCoder, ReturnsEveryMagnitude) {
  auto values = Boundaries();
  values.insert(values.end(), {0x7fffffff, 0x80000000, 0xfffffffe});
  RangeEncoder out;
  UnsignedModels written;
  for (std::uint32_t v : values) CodeUnsigned(out, written, v);
  const auto code = out.Finish();
  RangeDecoder in(code);
  UnsignedModels read;
  for (const std::uint32_t v : values) {
    std::uint32_t back = 0xdeadbeef;
    CodeUnsigned(in, read, back);
    EXPECT_EQ(back, v);
  }
  EXPECT_TRUE(in.AtEnd());
}

TEST(SignedCoder, ReturnsEveryMagnitude) {
  std::vector<std::int32_t> values;
  for (const std::uint32_t v : Boundaries()) {
    values.push_back(static_cast<std::int32_t>(v));
    values.push_back(-static_cast<std::int32_t>(v));
  }
  values.push_back(std::numeric_limits<std::int32_t>::max());
  values.push_back(-std::numeric_limits<std::int32_t>::max());
  RangeEncoder out;
  SignedModels written;
  for (std::int32_t v : values) CodeSigned(out, written, v);
  const auto code = out.Finish();
  RangeDecoder in(code);
  SignedModels read;
  for (const std::int32_t v : values) {
    std::int32_t back = 77;
    CodeSigned(in, read, back);
    EXPECT_EQ(back, v);
  }
  EXPECT_TRUE(in.AtEnd());
}

TEST(SignedCoder, LearnsToSpendLittleOnSmallNumbers) {
  std::mt19937 random(1);
  RangeEncoder out;
  SignedModels models;
  constexpr int kCount = 10000;
  for (int i = 0; i < kCount; ++i) {
    auto v = static_cast<std::int32_t>(random() % 3) - 1;
    CodeSigned(out, models, v);
  }
  EXPECT_LT(out.bits(), 1.65 * kCount);  // log2(3) = 1.585
}

TEST(SignedCoder, SurvivesGarbage) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> code(random() % 40);
    for (auto& b : code) b = static_cast<std::uint8_t>(i % 4 == 0 ? 0 : random());
    RangeDecoder in(code);
    SignedModels models;
    for (int j = 0; j < 100; ++j) {
      std::int32_t v = 0;
      CodeSigned(in, models, v);
      EXPECT_NE(v, std::numeric_limits<std::int32_t>::min());
    }
  }
}

}  // namespace
}  // namespace sac

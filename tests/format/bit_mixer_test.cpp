// SPDX-License-Identifier: Apache-2.0
#include "format/bit_mixer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "format/range_coder.h"

namespace sac {
namespace {

TEST(Logistic, IsTheCurveWithinAPercent) {
  for (std::int32_t x = -kMaxLogit; x <= kMaxLogit; ++x) {
    const double p = 65536 / (1 + std::exp(-x / 256.0));
    EXPECT_NEAR(Probability(x), p, 0.04 * std::min(p, 65536 - p) + 1) << x;
    EXPECT_EQ(Probability(x) + Probability(-x), 65536);
  }
  EXPECT_EQ(Probability(std::numeric_limits<std::int32_t>::max()), 65535);
  EXPECT_EQ(Probability(std::numeric_limits<std::int32_t>::min()), 1);
}

TEST(Logistic, LogitIsTheInverse) {
  for (std::uint32_t p = 0; p < 65536; ++p) {
    const std::int32_t x = Logit(p);
    if (x > -kMaxLogit && x < kMaxLogit) {
      EXPECT_LT(Probability(x - 1), static_cast<std::int32_t>(p) + 16);
      EXPECT_GE(Probability(x) + 16, static_cast<std::int32_t>(p));
    }
    EXPECT_GE(x, Logit(p > 0 ? p - 1 : 0));
  }
}

TEST(BitModel, FollowsTheFrequency) {
  std::mt19937 random(1);
  for (const unsigned percent : {3u, 50u, 90u}) {
    BitModel bit;
    EXPECT_EQ(bit.logit(), 0);
    double sum = 0;
    for (int i = 0; i < 4000; ++i) {
      bit.Update(random() % 100 < percent);
      if (i >= 2000) sum += bit.logit() / 2000.0;
    }
    const double wanted = 256 * std::log(percent / (100.0 - percent));
    EXPECT_NEAR(sum, wanted, 0.15 * std::abs(wanted) + 15) << percent;
  }
}

TEST(Mixer, LearnsWhomToTrust) {
  using Two = Mixer<2>;
  Two mixer({0, 0});
  std::mt19937 random(2);
  for (int i = 0; i < 3000; ++i) {
    const bool bit = random() % 2;
    const Two::Inputs inputs = {bit ? 300 : -300, random() % 2 ? 300 : -300};
    mixer.Learn(inputs, mixer.Mix(inputs), bit);
  }
  EXPECT_GT(mixer.Mix({300, 0}), 600);
  EXPECT_LT(std::abs(mixer.Mix({0, 300})), 200);
}

TEST(Mixer, TakesWhateverInputs) {
  std::mt19937 random(3);
  Mixer<2> mixer({std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min()});
  for (int i = 0; i < 100000; ++i) {
    const Mixer<2>::Inputs inputs = {3520, -3520};
    const std::int32_t mixed = mixer.Mix(inputs);
    EXPECT_LE(std::abs(mixed), kMaxLogit);
    mixer.Learn(inputs, mixed, i < 50000 ? random() % 2 : mixed < 0);
  }
}

TEST(CodeMixed, ComesBackAndCostsWhatItShould) {
  std::mt19937 random(4);
  constexpr int kBins = 5000;
  std::vector<bool> bits(kBins);
  for (int i = 0; i < kBins; ++i) bits[static_cast<std::size_t>(i)] = random() % 16 < (i % 2 ? 15u : 1u);
  static constexpr Mixer<3>::Inputs kWeights = {20000, 20000, 0};
  struct Models {
    std::array<BitModel, 2> by_parity;
    BitModel all;
    Mixer<3> first{kWeights}, second{kWeights};
  };
  const auto code = [&](auto& coder, Models& models, int i, bool& bit) {
    std::array<std::int32_t, 3> inputs = {0, 0, 256};
    const std::array states = {&models.by_parity[static_cast<std::size_t>(i % 2)], &models.all};
    CodeMixed(coder, models.first, models.second, inputs, states, bit);
  };
  RangeEncoder encoder;
  Models models;
  for (int i = 0; i < kBins; ++i) {
    bool bit = bits[static_cast<std::size_t>(i)];
    code(encoder, models, i, bit);
  }
  const std::vector<std::uint8_t> bytes = encoder.Finish();
  EXPECT_LT(8.0 * static_cast<double>(bytes.size()), 0.37 * kBins);  // the entropy is 0.337
  RangeDecoder decoder(bytes);
  models = Models();
  for (int i = 0; i < kBins; ++i) {
    bool bit = false;
    code(decoder, models, i, bit);
    ASSERT_EQ(bit, bits[static_cast<std::size_t>(i)]) << i;
  }
  EXPECT_TRUE(decoder.AtEnd());
}

}  // namespace
}  // namespace sac

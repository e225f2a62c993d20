// SPDX-License-Identifier: Apache-2.0
#include "format/range_coder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

// One coded item: `width` 0 is a bin of model `model`, otherwise raw bits.
struct Item {
  int width;
  std::size_t model;
  std::uint32_t value;
};

constexpr std::size_t kModels = 5;

std::vector<Item> RandomItems(std::mt19937& random, std::size_t count) {
  std::vector<Item> items(count);
  for (Item& item : items) {
    item.model = random() % kModels;
    item.width = random() % 8 == 0 ? 1 + static_cast<int>(random() % 32) : 0;
    // Model m is 1 with probability 2^-2m, so that sure and unsure models alternate.
    item.value = item.width == 0 ? random() % (1u << (2 * item.model)) == 0 : random() >> (32 - item.width);
  }
  return items;
}

Bytes Encode(const std::vector<Item>& items) {
  RangeEncoder coder;
  std::vector<BitModel> models(kModels);
  for (const Item& item : items) {
    std::uint32_t value = item.value;
    bool bit = value != 0;
    item.width == 0 ? coder.Bit(models[item.model], bit) : coder.Raw(value, item.width);
  }
  return coder.Finish();
}

// Reads values of the kinds in `items`; returns how many are the same.
std::size_t Decode(RangeDecoder& coder, const std::vector<Item>& items) {
  std::vector<BitModel> models(kModels);
  std::size_t same = 0;
  for (const Item& item : items) {
    std::uint32_t value = 0;
    bool bit = false;
    item.width == 0 ? coder.Bit(models[item.model], bit) : coder.Raw(value, item.width);
    same += (item.width == 0 ? bit : value) == item.value;
  }
  return same;
}

TEST(RangeCoder, ReturnsRandomItems) {
  std::mt19937 random(1);
  for (int i = 0; i < 400; ++i) {
    const auto items = RandomItems(random, i < 100 ? static_cast<std::size_t>(i) : random() % 2000);
    const Bytes code = Encode(items);
    RangeDecoder coder(code);
    EXPECT_EQ(Decode(coder, items), items.size());
    EXPECT_TRUE(coder.ok());
    EXPECT_TRUE(coder.AtEnd());
  }
}

TEST(RangeCoder, PropagatesCarries) {
  // Zeros of a model that expects ones push the low end up to 0xff..., where a carry runs through many bytes.
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    std::vector<Item> items;
    for (int j = 0; j < 300; ++j) items.push_back({1 + static_cast<int>(random() % 3), 0, 0});
    items.back().value = 1;
    items[random() % items.size()].value = 1;
    const Bytes code = Encode(items);
    RangeDecoder coder(code);
    EXPECT_EQ(Decode(coder, items), items.size());
  }
}

TEST(RangeCoder, KeepsZeroBytesBeforeItsEnding) {
  // Ones leave the low end at zero, so that the whole code is zero bytes; only those of the ending may be left out.
  RangeEncoder encoder;
  std::uint32_t ones = 0xffff;
  for (int i = 0; i < 20; ++i) encoder.Raw(ones, 16);
  const Bytes code = encoder.Finish();
  RangeDecoder decoder(code);
  for (int i = 0; i < 20; ++i) {
    std::uint32_t value = 0;
    decoder.Raw(value, 16);
    EXPECT_EQ(value, 0xffffu);
  }
  EXPECT_TRUE(decoder.AtEnd());
}

TEST(RangeCoder, OfNothingIsEmpty) {
  EXPECT_TRUE(Encode({}).empty());
  RangeDecoder coder({});
  EXPECT_TRUE(coder.AtEnd());
}

double Entropy(double p) { return p <= 0 || p >= 1 ? 0 : -p * std::log2(p) - (1 - p) * std::log2(1 - p); }

TEST(RangeCoder, ComesWithinOnePercentOfItsModelsAndNearTheEntropy) {
  for (const double p : {0.5, 0.2, 0.05, 0.99}) {
    std::mt19937 random(3);
    RangeEncoder coder;
    BitModel model;
    constexpr int kBits = 200000;
    double ideal = 0;
    for (int i = 0; i < kBits; ++i) {
      bool bit = random() * 0x1p-32 < p;
      const double q = model.probability() / 65536.0;
      ideal -= std::log2(bit ? q : 1 - q);
      coder.Bit(model, bit);
    }
    const double bits = 8.0 * static_cast<double>(coder.Finish().size());
    EXPECT_NEAR(bits, ideal, 0.01 * ideal) << p;
    // Models that follow a source as quickly as 1/62 waver by about a hundredth of a bit per bin.
    EXPECT_LT(bits, kBits * (Entropy(p) + 0.01)) << p;
    EXPECT_GT(bits, kBits * Entropy(p) * 0.98) << p;  // less would be magic
  }
}

TEST(RangeCoder, RawBitsCostABitEach) {
  std::mt19937 random(4);
  RangeEncoder coder;
  for (int i = 0; i < 1000; ++i) {
    std::uint32_t value = static_cast<std::uint32_t>(random());
    coder.Raw(value, 32);
  }
  EXPECT_NEAR(coder.bits(), 32000, 1);
  EXPECT_NEAR(static_cast<double>(coder.Finish().size()), 4000, 2);
}

TEST(RangeCoder, SaysHowLongTheCodeIs) {
  std::mt19937 random(5);
  RangeEncoder coder;
  EXPECT_NEAR(coder.bits(), 0, 1e-6);
  BitModel model;
  double before = 0;
  for (int i = 0; i < 5000; ++i) {
    bool bit = random() % 7 == 0;
    const double p = model.probability() / 65536.0;
    coder.Bit(model, bit);
    EXPECT_NEAR(coder.bits() - before, -std::log2(bit ? p : 1 - p), 0.01);
    before = coder.bits();
  }
  EXPECT_NEAR(8.0 * static_cast<double>(coder.Finish().size()), before, 16);
}

TEST(RangeCoder, SurvivesGarbage) {
  std::mt19937 random(6);
  for (int i = 0; i < 300; ++i) {
    Bytes code(random() % 60);
    for (auto& b : code) b = static_cast<std::uint8_t>(i % 3 == 0 ? 0xff : random());
    const auto items = RandomItems(random, 3000);  // about 15 raw bits for 8 items: more than there is
    RangeDecoder coder(code);
    Decode(coder, items);
    EXPECT_FALSE(coder.ok());
    EXPECT_FALSE(coder.AtEnd());
    std::uint32_t value = 0;
    coder.Raw(value, 32);
    EXPECT_FALSE(coder.ok());
  }
}

// Raw bits consume the same number of bytes whatever they are.
std::vector<Item> RandomRaw(std::mt19937& random, std::size_t count) {
  std::vector<Item> items(count);
  for (Item& item : items) item = {16, 0, static_cast<std::uint32_t>(random() & 0xffff)};
  return items;
}

TEST(RangeCoder, NoticesMissingBytes) {
  std::mt19937 random(7);
  for (int i = 0; i < 200; ++i) {
    const auto items = RandomRaw(random, 10 + random() % 40);
    const Bytes code = Encode(items);
    for (std::size_t size = 0; size < code.size(); ++size) {
      const Bytes prefix(code.begin(), code.begin() + static_cast<std::ptrdiff_t>(size));
      RangeDecoder coder(prefix);
      const bool whole = Decode(coder, items) == items.size();
      EXPECT_FALSE(whole && coder.ok());
      if (code.size() - size > 4) {
        EXPECT_FALSE(coder.ok());
      }
    }
  }
}

// Of a code that is cut off, what is certain is right, and nothing is given up that four more bytes could not change.
TEST(RangeCoder, KnowsWhatIsCertain) {
  std::mt19937 random(11);
  for (int i = 0; i < 50; ++i) {
    const auto items = RandomItems(random, 300);
    const Bytes code = Encode(items);
    std::size_t before = 0;
    for (std::size_t size = 0; size <= code.size(); ++size) {
      const Bytes prefix(code.begin(), code.begin() + static_cast<std::ptrdiff_t>(size));
      RangeDecoder coder(prefix);
      std::vector<BitModel> models(kModels);
      std::size_t certain = 0;
      for (std::size_t n = 0; n < items.size(); ++n) {
        std::uint32_t value = 0;
        bool bit = false;
        items[n].width == 0 ? coder.Bit(models[items[n].model], bit) : coder.Raw(value, items[n].width);
        if (!coder.IsCertain()) break;
        ASSERT_EQ(items[n].width == 0 ? bit : value, items[n].value) << "item " << n << " of " << size << " bytes";
        ++certain;
      }
      EXPECT_GE(certain, before);
      before = certain;
    }
    EXPECT_GE(before, items.size() - 40);  // 32 bits of the likeliest bins and more
  }
}

// An encoder may end the code with any number of the last interval, but not with zeros that can be left out, nor with
// bytes that a decoder does not read.
TEST(RangeCoder, HasNoSuperfluousBytes) {
  std::mt19937 random(11);
  const auto taken = [](const Bytes& code, const std::vector<Item>& items) {
    RangeDecoder coder(code);
    return Decode(coder, items) == items.size() && coder.AtEnd();
  };
  int other_ends = 0;
  for (int i = 0; i < 300; ++i) {
    const auto items = RandomItems(random, random() % 40);
    const Bytes code = Encode(items);
    ASSERT_TRUE(taken(code, items));
    Bytes longer = code;
    for (int size = 1; size <= 6; ++size) {
      longer.push_back(0);
      EXPECT_FALSE(taken(longer, items));
      longer.back() = static_cast<std::uint8_t>(1 + random() % 255);
      EXPECT_TRUE(size < 5 || !taken(longer, items));
      other_ends += taken(longer, items);
    }
  }
  EXPECT_GT(other_ends, 100);
}

TEST(RangeCoder, NoticesSurplusBytes) {
  std::mt19937 random(8);
  for (int i = 0; i < 200; ++i) {
    const auto items = RandomRaw(random, random() % 500);
    Bytes code = Encode(items);
    for (int surplus = 0; surplus < 5; ++surplus) code.push_back(static_cast<std::uint8_t>(random()));
    RangeDecoder coder(code);
    Decode(coder, items);
    EXPECT_TRUE(coder.ok());
    EXPECT_FALSE(coder.AtEnd());
  }
}

TEST(BitModel, FollowsItsSource) {
  BitModel model;
  EXPECT_EQ(model.probability(), 32768u);
  model.Update(true);
  EXPECT_GT(model.probability(), 48000u);  // the first bin counts much
  for (int i = 0; i < 5000; ++i) model.Update(true);
  EXPECT_EQ(model.probability(), 65474u);
  for (int i = 0; i < 5000; ++i) model.Update(false);
  EXPECT_EQ(model.probability(), 61u);
  std::mt19937 random(9);
  double mean = 0;
  for (int i = 0; i < 20000; ++i) {
    model.Update(random() * 0x1p-32 < 0.3);
    if (i >= 1000) mean += model.probability() / 65536.0 / 19000;
  }
  EXPECT_NEAR(mean, 0.3, 0.01);
}

}  // namespace
}  // namespace sac

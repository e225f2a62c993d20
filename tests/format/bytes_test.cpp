// SPDX-License-Identifier: Apache-2.0
#include "format/bytes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes Varint(std::uint32_t v) {
  ByteWriter out;
  out.Varint(v);
  return out.bytes();
}

bool IsVarint(const Bytes& bytes) {
  ByteReader in(bytes);
  in.Varint();
  return in.ok() && in.remaining() == 0;
}

TEST(Varint, HasTheBytesOfTheDefinition) {
  EXPECT_EQ(Varint(0), Bytes({0}));
  EXPECT_EQ(Varint(127), Bytes({127}));
  EXPECT_EQ(Varint(128), Bytes({0x80, 1}));
  EXPECT_EQ(Varint(300), Bytes({0xac, 2}));
  EXPECT_EQ(Varint(0xffffffffu), Bytes({0xff, 0xff, 0xff, 0xff, 0x0f}));
}

TEST(Varint, ComesBack) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    const int shift = i % 32;
    // Around every power of two, and anywhere below it.
    const std::uint32_t v = i % 2 ? random() >> shift : (1u << shift) + static_cast<std::uint32_t>(random() % 5) - 2;
    const Bytes bytes = Varint(v);
    ByteReader in(bytes);
    EXPECT_EQ(in.Varint(), v);
    EXPECT_TRUE(in.ok());
    EXPECT_EQ(in.remaining(), 0u);
    EXPECT_EQ(bytes.size(), static_cast<std::size_t>(std::max<int>(1, (std::bit_width(v) + 6) / 7)));
  }
}

TEST(Varint, HasOneSpelling) {
  EXPECT_FALSE(IsVarint({0x80, 0}));  // zero
  EXPECT_FALSE(IsVarint({0xff, 0}));  // 127
  EXPECT_FALSE(IsVarint({0x80, 0x80, 0x80, 0x80, 0}));
  EXPECT_TRUE(IsVarint({0}));
}

TEST(Varint, StaysWithin32Bits) {
  EXPECT_TRUE(IsVarint({0xff, 0xff, 0xff, 0xff, 0x0f}));
  EXPECT_FALSE(IsVarint({0xff, 0xff, 0xff, 0xff, 0x10}));        // 33 bits
  EXPECT_FALSE(IsVarint({0x80, 0x80, 0x80, 0x80, 0x80, 0x01}));  // six bytes
}

TEST(ByteReader, LatchesAMalformedVarint) {
  const Bytes bytes = {0x80, 0, 7};
  ByteReader in(bytes);
  EXPECT_EQ(in.Varint(), 0u);
  in.U8();
  EXPECT_FALSE(in.ok());
}

TEST(ByteReader, LatchesTruncationAndYieldsZero) {
  for (const Bytes& bytes : {Bytes{}, Bytes{0xff}, Bytes{0xff, 0xff, 0xff}}) {
    ByteReader word(bytes), varint(bytes), span(bytes);
    word.U32();
    EXPECT_FALSE(word.ok());
    EXPECT_EQ(word.U8(), 0);
    EXPECT_EQ(varint.Varint(), 0u);
    EXPECT_FALSE(varint.ok());
    EXPECT_TRUE(span.Bytes(bytes.size() + 1).empty());
    EXPECT_FALSE(span.ok());
    EXPECT_EQ(span.remaining(), bytes.size());
  }
}

TEST(ByteReader, RefusesACountThatWouldWrap) {
  const Bytes bytes = {1, 2, 3};
  ByteReader in(bytes);
  in.U8();
  EXPECT_TRUE(in.Bytes(std::numeric_limits<std::size_t>::max()).empty());
  EXPECT_FALSE(in.ok());
}

TEST(ByteReader, ReadsWhatIsWritten) {
  ByteWriter out;
  out.U8(0xfe);
  out.U32(0x01020304);
  out.F32(-0.1f);
  out.F32(std::numeric_limits<float>::infinity());
  out.F64(-0.1);
  out.Varint(123456);
  out.Bytes(Bytes{9, 8, 7});
  EXPECT_EQ(out.size(), out.bytes().size());
  EXPECT_EQ(out.bytes()[1], 4);  // little end first

  ByteReader in(out.bytes());
  EXPECT_EQ(in.U8(), 0xfe);
  EXPECT_EQ(in.U32(), 0x01020304u);
  EXPECT_EQ(in.F32(), -0.1f);
  EXPECT_TRUE(std::isinf(in.F32()));
  EXPECT_EQ(in.F64(), -0.1);
  EXPECT_EQ(in.Varint(), 123456u);
  EXPECT_EQ(in.position(), out.size() - 3);
  const auto rest = in.Bytes(3);
  EXPECT_EQ(Bytes(rest.begin(), rest.end()), Bytes({9, 8, 7}));
  EXPECT_TRUE(in.ok());
  EXPECT_EQ(in.remaining(), 0u);
}

}  // namespace
}  // namespace sac

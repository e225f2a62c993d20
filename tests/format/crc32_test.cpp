// SPDX-License-Identifier: Apache-2.0
#include "format/crc32.h"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace sac {
namespace {

std::vector<std::uint8_t> Bytes(std::string_view text) { return {text.begin(), text.end()}; }

TEST(Crc32, HasThePublishedCheckValue) {
  EXPECT_EQ(Crc32(Bytes("123456789")), 0xCBF43926u);
  EXPECT_EQ(Crc32({}), 0u);
  EXPECT_EQ(Crc32(Bytes("a")), 0xE8B7BE43u);
}

TEST(Crc32, GoesOnWhereItStopped) {
  const auto bytes = Bytes("The quick brown fox jumps over the lazy dog");
  ASSERT_EQ(Crc32(bytes), 0x414FA339u);
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    const std::span<const std::uint8_t> all(bytes);
    EXPECT_EQ(Crc32(all.subspan(cut), Crc32(all.first(cut))), 0x414FA339u);
  }
}

TEST(Crc32, NoticesEverySingleBit) {
  auto bytes = Bytes("packet");
  const std::uint32_t crc = Crc32(bytes);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1 << (bit % 8));
    EXPECT_NE(Crc32(bytes), crc);
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1 << (bit % 8));
  }
}

}  // namespace
}  // namespace sac

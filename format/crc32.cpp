// SPDX-License-Identifier: Apache-2.0
#include "format/crc32.h"

#include <array>

namespace sac {
namespace {

constexpr std::array<std::uint32_t, 256> kTable = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int k = 0; k < 8; ++k) c = (c & 1) ? 0xEDB88320u ^ (c >> 1) : c >> 1;
    table[i] = c;
  }
  return table;
}();

// Polynomials over GF(2) modulo the CRC's, the coefficient of x^0 in the top bit.
constexpr std::uint32_t kOne = 1u << 31;

constexpr std::uint32_t Product(std::uint32_t a, std::uint32_t b) {
  std::uint32_t product = 0;
  for (std::uint32_t bit = kOne; bit != 0; bit >>= 1) {
    if (a & bit) product ^= b;
    b = (b & 1) ? 0xEDB88320u ^ (b >> 1) : b >> 1;
  }
  return product;
}

// kPowers[i][n] = x^(8 * n * 256^i).
constexpr std::array<std::array<std::uint32_t, 256>, 4> kPowers = [] {
  std::array<std::array<std::uint32_t, 256>, 4> powers{};
  std::uint32_t base = kOne >> 8;
  for (auto& digit : powers) {
    digit[0] = kOne;
    for (std::size_t n = 1; n < digit.size(); ++n) digit[n] = Product(digit[n - 1], base);
    base = Product(digit.back(), base);
  }
  return powers;
}();

}  // namespace

std::uint32_t Crc32OfLast(std::uint32_t before, std::uint32_t all, std::uint64_t count) {
  // Appending n bytes multiplies what came before by x^(8 n).
  for (std::size_t i = 0; i < kPowers.size(); ++i) {
    if (const std::size_t digit = (count >> (8 * i)) & 0xff; digit != 0) before = Product(kPowers[i][digit], before);
  }
  return before ^ all;
}

std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc) {
  crc = ~crc;
  for (const std::uint8_t b : bytes) crc = kTable[(crc ^ b) & 0xff] ^ (crc >> 8);
  return ~crc;
}

}  // namespace sac

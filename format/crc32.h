// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace sac {

// The CRC-32 of ISO 3309 (reflected polynomial 0xEDB88320, as in zlib and PNG) of `bytes` (spec.md 2.4). `crc` is the
// result for the bytes before them, 0 at the beginning.
std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0);

// The CRC-32 of the last `count` bytes of a sequence, without reading them. `before` is the CRC-32 of the bytes before
// these, `all` the CRC-32 of the whole sequence. `count` is below 2^32.
std::uint32_t Crc32OfLast(std::uint32_t before, std::uint32_t all, std::uint64_t count);

// The CRC-32 of any bytes followed by their own CRC-32 in little-endian order.
inline constexpr std::uint32_t kCrc32Residue = 0x2144DF1Cu;

}  // namespace sac

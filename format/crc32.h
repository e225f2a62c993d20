#pragma once

#include <cstdint>
#include <span>

namespace sac {

// CRC-32 of ISO 3309 (reflected polynomial 0xEDB88320, as in zlib and PNG), spec.md 2.4. Pass the result of the bytes
// before to go on.
std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0);

// The CRC-32 of the last `count` bytes of some, without looking at them: `before` is that of the bytes before these,
// `all` that of all. `count` is below 2^32.
std::uint32_t Crc32OfLast(std::uint32_t before, std::uint32_t all, std::uint64_t count);

// The CRC-32 of any bytes with their own CRC-32 behind, little-endian.
inline constexpr std::uint32_t kCrc32Residue = 0x2144DF1Cu;

}  // namespace sac

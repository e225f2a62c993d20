#pragma once

#include <cstdint>
#include <span>

namespace sac {

// CRC-32 of ISO 3309 (reflected polynomial 0xEDB88320, as in zlib and PNG), spec.md 2.4. Pass the result of the bytes
// before to go on.
std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0);

}  // namespace sac

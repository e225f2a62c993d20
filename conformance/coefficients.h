#pragma once

#include <cstdint>
#include <span>

#include "format/status.h"

namespace sac {

// The CRC-32 of all coefficients of a stream (conformance/README.md): what a decoder must get exactly right.
Status CoefficientsCrc32(std::span<const std::uint8_t> stream, std::uint32_t& crc);

}  // namespace sac

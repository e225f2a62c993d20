// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "format/group.h"
#include "format/prediction.h"
#include "sac/status.h"

namespace sac {

// Reads the coefficients of a stream without any floating-point arithmetic. Calls `take` for each frame with its slot,
// which has the references that the frame uses, and its coefficients. Groups come in the order of the stream, and the
// frames of a group in display order.
Status ReadCoefficients(std::span<const std::uint8_t> stream,
                        const std::function<void(const FrameSlot&, const FrameCoefficients&)>& take);

// Continues the CRC-32 `crc` with a frame's coefficients (conformance/README.md), which every decoder must decode
// exactly.
std::uint32_t CoefficientsCrc32(const FrameCoefficients& coefficients, std::uint32_t crc);

// Computes the CRC-32 of the coefficients of all frames of a stream.
Status CoefficientsCrc32(std::span<const std::uint8_t> stream, std::uint32_t& crc);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "format/group_structure.h"
#include "format/prediction.h"
#include "sac/status.h"

namespace sac {

// Reads the integers of a stream without any float: calls `take` for each frame, group after group and by time within
// each, with its slot (the references it really has) and its coefficients.
Status ReadCoefficients(std::span<const std::uint8_t> stream,
                        const std::function<void(const FrameSlot&, const FrameCoefficients&)>& take);

// Goes on with the CRC-32 of a frame's coefficients (conformance/README.md): what a decoder must get exactly right.
std::uint32_t CoefficientsCrc32(const FrameCoefficients& coefficients, std::uint32_t crc);

// Of all frames of a stream.
Status CoefficientsCrc32(std::span<const std::uint8_t> stream, std::uint32_t& crc);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "format/range_coder.h"

namespace sac {

// The models of the adaptive Exp-Golomb code of an unsigned integer up to 2^32 - 2 (spec.md 7.3). The code is the
// number of bits of value + 1 in unary, each step with its own model, then the bits below the leading one without
// models.
struct UnsignedModels {
  std::array<BitModel, 32> prefix;
};

template <class Coder>
void CodeUnsigned(Coder& coder, UnsignedModels& models, std::uint32_t& value) {
  int width = 0;
  if constexpr (!Coder::kDecodes) {
    while (width < 31 && ((value + 1) >> (width + 1)) != 0) ++width;
  }
  for (int i = 0; i < 31; ++i) {
    bool more = i < width;
    coder.Bit(models.prefix[static_cast<std::size_t>(i)], more);
    if (!more) break;
    if constexpr (Coder::kDecodes) width = i + 1;
  }
  std::uint32_t low = (value + 1) & ((1u << width) - 1);
  coder.Raw(low, width);
  if constexpr (Coder::kDecodes) value = ((1u << width) | low) - 1;
}

// Codes a magnitude of 1 or more in unary (spec.md 7.4). `code_bin(n, more)` codes whether the magnitude is above n,
// for n from 1 to `bins`. Returns the magnitude, or bins + 1 when it is larger than `bins`.
template <class Coder, class CodeBin>
std::uint32_t CodeUnary(std::uint32_t magnitude, std::uint32_t bins, CodeBin&& code_bin) {
  for (std::uint32_t n = 1; n <= bins; ++n) {
    bool more = !Coder::kDecodes && magnitude > n;
    code_bin(n, more);
    if (!more) return n;
  }
  return bins + 1;
}

// The models of a signed integer of magnitude below 2^31. The code is a zero flag, the sign without a model, and the
// magnitude minus one.
struct SignedModels {
  BitModel nonzero;
  UnsignedModels magnitude;
};

template <class Coder>
void CodeSigned(Coder& coder, SignedModels& models, std::int32_t& value) {
  bool nonzero = value != 0;
  coder.Bit(models.nonzero, nonzero);
  if (!nonzero) {
    value = 0;
    return;
  }
  std::uint32_t negative = value < 0;
  coder.Raw(negative, 1);
  std::uint32_t magnitude = static_cast<std::uint32_t>(value < 0 ? -static_cast<std::int64_t>(value) : value) - 1;
  CodeUnsigned(coder, models.magnitude, magnitude);
  if constexpr (Coder::kDecodes) {
    const auto m = static_cast<std::int64_t>(std::min(magnitude, 0x7ffffffeu)) + 1;
    value = static_cast<std::int32_t>(negative ? -m : m);
  }
}

}  // namespace sac

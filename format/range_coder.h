// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "format/bit_model.h"

namespace sac {

// A binary range encoder with 32 bits of state (spec.md 7.1). Encoder and decoder have the same calls, which write or
// read their argument, so that one template per syntax element serves both directions.
class RangeEncoder {
 public:
  static constexpr bool kDecodes = false;

  // Codes a bin by `model` and updates the model.
  void Bit(BitModel& model, bool& bit);
  // Codes a bin that is 1 with a probability of p / 65536; `p` is from 1 to 65535.
  void Decide(std::uint32_t p, bool& bit);
  // Codes the low `count` bits of `value` with equal probabilities, the most significant one first.
  void Raw(std::uint32_t& value, int count);
  bool ok() const { return true; }

  // Ends the code with the fewest bytes and returns the whole code. Zeros among the last four bytes are left out.
  std::vector<std::uint8_t> Finish();
  // The length of the code so far in bits, for accounts of its parts.
  double bits() const {
    return 8.0 * static_cast<double>(bytes_.size()) + 32.0 - std::log2(static_cast<double>(range_));
  }

 private:
  void Narrow(std::uint32_t offset, std::uint32_t range);
  void Split(std::uint32_t bound, bool bit);

  std::vector<std::uint8_t> bytes_;
  std::uint32_t low_ = 0;
  std::uint32_t range_ = 0xffffffffu;
};

// Reads the code of a RangeEncoder. Bytes after the end read as zero, and ok() becomes false for good once more than
// the four bytes that an encoder may leave out have been read. The decoder never reads outside the span and has no
// other failure.
class RangeDecoder {
 public:
  static constexpr bool kDecodes = true;

  explicit RangeDecoder(std::span<const std::uint8_t> bytes);

  void Bit(BitModel& model, bool& bit);
  void Decide(std::uint32_t p, bool& bit);
  void Raw(std::uint32_t& value, int count);
  bool ok() const { return position_ <= bytes_.size() + 4; }
  // Whether the code ends where the bytes do (spec.md 7.1).
  bool AtEnd() const;
  // Whether everything read so far is the same for any bytes that may follow. In a code that is cut off, everything
  // after that point is made up.
  bool IsCertain() const;

 private:
  std::uint8_t Next() {
    const std::size_t i = position_++;
    return i < bytes_.size() ? bytes_[i] : 0;
  }
  void Normalize();
  bool Split(std::uint32_t bound);

  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
  std::uint32_t code_ = 0;
  std::uint32_t range_ = 0xffffffffu;
};

}  // namespace sac

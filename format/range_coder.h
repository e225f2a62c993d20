#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sac {

// Probability that a bin is 1: the mean of a fast and a slow estimator, both faster while young (spec.md 7.2).
class BitModel {
 public:
  // In 1/32768, from 8 to 32760.
  std::uint32_t probability() const {
    const std::uint32_t p = (fast_ + slow_) >> 2;
    return p < 8 ? 8 : p > 32760 ? 32760 : p;
  }
  void Update(bool bit);

 private:
  std::uint32_t fast_ = 32768;  // in 1/65536
  std::uint32_t slow_ = 32768;
  std::uint32_t count_ = 0;
};

// A binary range coder over 32 bits (spec.md 7.1). Encoder and decoder offer the same calls, which write or read their
// argument, so that one template per syntax element serves both directions.
class RangeEncoder {
 public:
  static constexpr bool kDecodes = false;

  void Bit(BitModel& model, bool& bit);
  // A bin that is 1 with a probability of `p` / 65536, from 1 to 65535.
  void Decide(std::uint32_t p, bool& bit);
  // `count` bits of equal probability, most significant first.
  void Raw(std::uint32_t& value, int count);
  bool ok() const { return true; }

  // Ends the code with the fewest bytes and returns all of them; the zeros among the last four are left out.
  std::vector<std::uint8_t> Finish();
  // Length of the code so far in bits, to account for its parts.
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

// Reads the code of a RangeEncoder. Bytes after the end read as zero; reading more than the four that an encoder may
// have left out latches ok() to false. Never reads outside the span, never fails otherwise.
class RangeDecoder {
 public:
  static constexpr bool kDecodes = true;

  explicit RangeDecoder(std::span<const std::uint8_t> bytes);

  void Bit(BitModel& model, bool& bit);
  void Decide(std::uint32_t p, bool& bit);
  void Raw(std::uint32_t& value, int count);
  bool ok() const { return position_ <= bytes_.size() + 4; }
  // Whether the code ends where the bytes do, and as an encoder ends it (spec.md 7.1): no other bytes say the same.
  bool AtEnd() const;
  // Whether what was read would be the same if other bytes followed: of a code that is cut off, all else is made up.
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

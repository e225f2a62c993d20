// SPDX-License-Identifier: Apache-2.0
#include "format/range_coder.h"

#include <algorithm>

namespace sac {
namespace {

constexpr std::uint32_t kTop = 1u << 24;

// The multiple of the greatest power of two among the integers from `low` to `low` + `range` - 1, with which a code
// ends in the fewest bytes (non-normative).
std::uint64_t RoundestBetween(std::uint32_t low, std::uint32_t range) {
  for (int bits = 32;; --bits) {
    const std::uint64_t unit = std::uint64_t{1} << bits, value = (low + unit - 1) / unit * unit;
    if (value - low < range) return value;
  }
}

}  // namespace

void RangeEncoder::Narrow(std::uint32_t offset, std::uint32_t range) {
  const std::uint32_t before = low_;
  low_ += offset;
  range_ = range;
  if (low_ < before) {  // carry into the bytes already written
    for (std::size_t i = bytes_.size(); i-- > 0;) {
      if (++bytes_[i] != 0) break;
    }
  }
  while (range_ < kTop) {
    bytes_.push_back(static_cast<std::uint8_t>(low_ >> 24));
    low_ <<= 8;
    range_ <<= 8;
  }
}

void RangeEncoder::Split(std::uint32_t bound, bool bit) {
  if (bit) {
    Narrow(0, bound);
  } else {
    Narrow(bound, range_ - bound);
  }
}

void RangeEncoder::Bit(BitModel& model, bool& bit) {
  Decide(model.probability(), bit);
  model.Update(bit);
}

void RangeEncoder::Decide(std::uint32_t p, bool& bit) { Split((range_ >> 16) * p, bit); }

void RangeEncoder::Raw(std::uint32_t& value, int count) {
  for (int i = count - 1; i >= 0; --i) {
    Split(range_ >> 1, (value >> i) & 1);
  }
}

std::vector<std::uint8_t> RangeEncoder::Finish() {
  const std::uint64_t value = RoundestBetween(low_, range_);
  Narrow(static_cast<std::uint32_t>(value - low_), range_);
  for (int shift = 24; shift >= 0; shift -= 8) bytes_.push_back(static_cast<std::uint8_t>(low_ >> shift));
  // Readers take four bytes at most after the end for zeros, those of this ending; zeros before it stay.
  for (int i = 0; i < 4 && bytes_.back() == 0; ++i) bytes_.pop_back();
  return std::move(bytes_);
}

RangeDecoder::RangeDecoder(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
  for (int i = 0; i < 4; ++i) code_ = (code_ << 8) | Next();
}

bool RangeDecoder::AtEnd() const {
  if (!ok() || position_ < bytes_.size()) return false;
  // An encoder leaves out the zeros among the last four bytes.
  return position_ == bytes_.size() + 4 || bytes_.back() != 0;
}

bool RangeDecoder::IsCertain() const {
  if (!ok()) return false;
  const std::size_t missing = std::max(position_, bytes_.size()) - bytes_.size();  // bytes of code_ taken for zeros
  return code_ + ((std::uint64_t{1} << (8 * missing)) - 1) < range_;
}

void RangeDecoder::Normalize() {
  while (range_ < kTop) {
    code_ = (code_ << 8) | Next();
    range_ <<= 8;
  }
}

bool RangeDecoder::Split(std::uint32_t bound) {
  const bool bit = code_ < bound;
  if (bit) {
    range_ = bound;
  } else {
    code_ -= bound;
    range_ -= bound;
  }
  Normalize();
  return bit;
}

void RangeDecoder::Bit(BitModel& model, bool& bit) {
  Decide(model.probability(), bit);
  model.Update(bit);
}

void RangeDecoder::Decide(std::uint32_t p, bool& bit) { bit = Split((range_ >> 16) * p); }

void RangeDecoder::Raw(std::uint32_t& value, int count) {
  value = 0;
  for (int i = 0; i < count; ++i) {
    value = (value << 1) | static_cast<std::uint32_t>(Split(range_ >> 1));
  }
}

}  // namespace sac

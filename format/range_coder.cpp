// SPDX-License-Identifier: Apache-2.0
#include "format/range_coder.h"

#include <algorithm>
#include <array>

namespace sac {
namespace {

constexpr std::uint32_t kTop = 1u << 24;
constexpr std::uint32_t kYoung = 127;  // from this count on both rates are constant

// spec.md 7.2: the n-th bin moves an estimator by 1 / (n + 1.5), but at least by its own rate.
constexpr std::array<std::uint32_t, kYoung + 1> Rates(std::uint32_t floor) {
  std::array<std::uint32_t, kYoung + 1> rates{};
  for (std::uint32_t n = 0; n <= kYoung; ++n) rates[n] = std::max(131072 / (2 * n + 3), floor);
  return rates;
}

// The end of a code: the multiple of the greatest power of two among the integers from `low` to `low` + `range` - 1. It
// is unique, since of two neighbouring multiples of a power of two one is a multiple of the next power.
std::uint64_t RoundestBetween(std::uint32_t low, std::uint32_t range) {
  for (int bits = 32;; --bits) {
    const std::uint64_t unit = std::uint64_t{1} << bits, value = (low + unit - 1) / unit * unit;
    if (value - low < range) return value;
  }
}

constexpr auto kFast = Rates(4096);  // 1/16
constexpr auto kSlow = Rates(512);   // 1/128

}  // namespace

void BitModel::Update(bool bit) {
  // All values are below 2^16 and all rates below 2^16, so the products fit 32 bits.
  if (bit) {
    fast_ += ((65535 - fast_) * kFast[count_]) >> 16;
    slow_ += ((65535 - slow_) * kSlow[count_]) >> 16;
  } else {
    fast_ -= (fast_ * kFast[count_]) >> 16;
    slow_ -= (slow_ * kSlow[count_]) >> 16;
  }
  if (count_ < kYoung) ++count_;
}

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
  Split((range_ >> 15) * model.probability(), bit);
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
  if (bytes_.size() + 4 > position_ && !bytes_.empty() && bytes_.back() == 0) return false;
  std::uint32_t last = 0;
  for (std::size_t i = position_ - 4; i < position_; ++i) last = (last << 8) | (i < bytes_.size() ? bytes_[i] : 0);
  const std::uint32_t low = last - code_;
  return std::uint64_t{low} + code_ == RoundestBetween(low, range_);
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
  bit = Split((range_ >> 15) * model.probability());
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

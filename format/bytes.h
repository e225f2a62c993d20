// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sac {

static_assert(std::endian::native == std::endian::little,
              "the processor must be little-endian: Draco reads meshes in the byte order of the processor");

// Writes little-endian bytes and varints (spec.md 2.2). A varint holds 7 bits a byte, least significant first. It has
// at most 5 bytes and never a superfluous final zero byte, so that every value has one spelling.
class ByteWriter {
 public:
  void U8(std::uint8_t v) { bytes_.push_back(v); }
  void U32(std::uint32_t v) {
    for (int i = 0; i < 4; ++i) U8(static_cast<std::uint8_t>(v >> (8 * i)));
  }
  void F32(float v) { U32(std::bit_cast<std::uint32_t>(v)); }
  void F64(double v) {
    const auto bits = std::bit_cast<std::uint64_t>(v);
    U32(static_cast<std::uint32_t>(bits));
    U32(static_cast<std::uint32_t>(bits >> 32));
  }
  void Varint(std::uint32_t v) {
    for (; v >= 0x80; v >>= 7) U8(static_cast<std::uint8_t>(v | 0x80));
    U8(static_cast<std::uint8_t>(v));
  }
  void Bytes(std::span<const std::uint8_t> b) { bytes_.insert(bytes_.end(), b.begin(), b.end()); }

  std::size_t size() const { return bytes_.size(); }
  std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

// Reads what ByteWriter writes. A read past the end or a malformed varint latches ok() to false and yields zero, so
// callers check once at the end.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint8_t U8() {
    if (position_ >= bytes_.size()) {
      ok_ = false;
      return 0;
    }
    return bytes_[position_++];
  }
  std::uint32_t U32() {
    std::uint32_t v = 0;
    for (int i = 0; i < 4; ++i) v |= static_cast<std::uint32_t>(U8()) << (8 * i);
    return v;
  }
  float F32() { return std::bit_cast<float>(U32()); }
  double F64() {
    const std::uint64_t low = U32(), high = U32();
    return std::bit_cast<double>(low | high << 32);
  }
  std::uint32_t Varint() {
    std::uint64_t v = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const std::uint8_t b = U8();
      v |= static_cast<std::uint64_t>(b & 0x7f) << shift;
      if (b & 0x80) continue;
      if ((b == 0 && shift > 0) || v > 0xffffffffu) break;
      return static_cast<std::uint32_t>(v);
    }
    ok_ = false;
    return 0;
  }
  // The next `count` bytes; empty and latched when there are fewer.
  std::span<const std::uint8_t> Bytes(std::size_t count) {
    if (count > remaining()) {
      ok_ = false;
      return {};
    }
    position_ += count;
    return bytes_.subspan(position_ - count, count);
  }

  bool ok() const { return ok_; }
  std::size_t position() const { return position_; }
  std::size_t remaining() const { return bytes_.size() - position_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

}  // namespace sac

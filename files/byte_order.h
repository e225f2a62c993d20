// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace sac {

// Numbers in files, independent of the machine's byte order. `bytes` holds as many as the number has.

inline std::uint32_t LoadLittle32(const char* bytes) {
  const auto at = [bytes](int i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])); };
  return at(0) | at(1) << 8 | at(2) << 16 | at(3) << 24;
}

inline std::uint32_t LoadBig32(const char* bytes) {
  const auto at = [bytes](int i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])); };
  return at(3) | at(2) << 8 | at(1) << 16 | at(0) << 24;
}

inline std::uint64_t LoadLittle64(const char* bytes) {
  return LoadLittle32(bytes) | std::uint64_t{LoadLittle32(bytes + 4)} << 32;
}

inline void StoreLittle32(std::uint32_t value, char* bytes) {
  for (int i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> (8 * i) & 0xFF);
}

inline void StoreBig32(std::uint32_t value, char* bytes) {
  for (int i = 0; i < 4; ++i) bytes[3 - i] = static_cast<char>(value >> (8 * i) & 0xFF);
}

inline void StoreLittle64(std::uint64_t value, char* bytes) {
  StoreLittle32(static_cast<std::uint32_t>(value), bytes);
  StoreLittle32(static_cast<std::uint32_t>(value >> 32), bytes + 4);
}

inline float LoadLittleFloat(const char* bytes) { return std::bit_cast<float>(LoadLittle32(bytes)); }
inline double LoadLittleDouble(const char* bytes) { return std::bit_cast<double>(LoadLittle64(bytes)); }
inline float LoadBigFloat(const char* bytes) { return std::bit_cast<float>(LoadBig32(bytes)); }
inline void StoreLittleFloat(float value, char* bytes) { StoreLittle32(std::bit_cast<std::uint32_t>(value), bytes); }
inline void StoreBigFloat(float value, char* bytes) { StoreBig32(std::bit_cast<std::uint32_t>(value), bytes); }

}  // namespace sac

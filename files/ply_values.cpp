// SPDX-License-Identifier: Apache-2.0
#include "files/ply_values.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "files/text_scan.h"

namespace sac {
namespace {

double Decode(PlyType type, std::uint64_t bits) {
  switch (type) {
    case PlyType::kInt8:
      return static_cast<std::int8_t>(bits);
    case PlyType::kInt16:
      return static_cast<std::int16_t>(bits);
    case PlyType::kInt32:
      return static_cast<std::int32_t>(bits);
    case PlyType::kFloat32:
      return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    case PlyType::kFloat64:
      return std::bit_cast<double>(bits);
    case PlyType::kUint8:
    case PlyType::kUint16:
    case PlyType::kUint32:
      break;
  }
  return static_cast<double>(bits);
}

}  // namespace

Status PlyValues::Take(PlyType type, double& value) {
  if (format_ == PlyHeader::Format::kAscii) {
    std::string_view rest = bytes_.substr(at_);
    word_ = TakeWord(rest);
    at_ = bytes_.size() - rest.size();
    if (word_.empty()) return Status::Corrupt("truncated");
    if (ParseDouble(word_, value)) return Status::Ok();
    return Status::Corrupt(Where() + NotANumber(word_).message());
  }
  const std::size_t size = PlyBytes(type);
  if (bytes_.size() - at_ < size) return Status::Corrupt("truncated");
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t from_high = format_ == PlyHeader::Format::kBigEndian ? i : size - 1 - i;
    bits = bits << 8 | static_cast<unsigned char>(bytes_[at_ + from_high]);
  }
  at_ += size;
  value = Decode(type, bits);
  return Status::Ok();
}

Status PlyValues::TakeCount(PlyType count_type, PlyType type, std::size_t& count) {
  double value = 0;
  SAC_RETURN_IF_ERROR(Take(count_type, value));
  // A number of text is a digit and a blank at least, but for the last.
  const bool ascii = format_ == PlyHeader::Format::kAscii;
  const std::size_t left = (bytes_.size() - at_ + 1) / (ascii ? 2 : PlyBytes(type));
  if (!(value >= 0) || value != std::floor(value)) return Status::Corrupt(Where() + "a list of no length");
  if (value > static_cast<double>(left)) return Status::Corrupt("truncated");
  count = static_cast<std::size_t>(value);
  return Status::Ok();
}

std::string PlyValues::Where() const {
  if (format_ != PlyHeader::Format::kAscii) return "";
  return "line " + std::to_string(LineNumber(bytes_, static_cast<std::size_t>(word_.data() - bytes_.data()))) + ", ";
}

}  // namespace sac

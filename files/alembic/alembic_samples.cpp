// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/alembic_samples.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "files/byte_order.h"

namespace sac {
namespace {

constexpr std::size_t kHashBytes = 16;  // before the numbers of each sample

std::uint16_t Load16(const char* bytes) {
  return static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[0]) | static_cast<unsigned char>(bytes[1]) << 8);
}

// A number as double, or, of whole numbers, as the int64 that it is.
template <typename Number>
Number Load(AlembicPod pod, const char* bytes) {
  switch (pod) {
    case AlembicPod::kBool:
    case AlembicPod::kUint8:
      return static_cast<Number>(static_cast<unsigned char>(*bytes));
    case AlembicPod::kInt8:
      return static_cast<Number>(static_cast<signed char>(*bytes));
    case AlembicPod::kUint16:
      return static_cast<Number>(Load16(bytes));
    case AlembicPod::kInt16:
      return static_cast<Number>(static_cast<std::int16_t>(Load16(bytes)));
    case AlembicPod::kUint32:
      return static_cast<Number>(LoadLittle32(bytes));
    case AlembicPod::kInt32:
      return static_cast<Number>(static_cast<std::int32_t>(LoadLittle32(bytes)));
    case AlembicPod::kUint64:
      return static_cast<Number>(LoadLittle64(bytes));
    case AlembicPod::kInt64:
      return static_cast<Number>(static_cast<std::int64_t>(LoadLittle64(bytes)));
    case AlembicPod::kFloat16:
      return static_cast<Number>(HalfToFloat(Load16(bytes)));
    case AlembicPod::kFloat32:
      return static_cast<Number>(LoadLittleFloat(bytes));
    default:
      return static_cast<Number>(LoadLittleDouble(bytes));
  }
}

bool IsFloat(AlembicPod pod) {
  return pod == AlembicPod::kFloat16 || pod == AlembicPod::kFloat32 || pod == AlembicPod::kFloat64;
}

}  // namespace

float HalfToFloat(std::uint16_t half) {
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000) << 16;
  const int exponent = half >> 10 & 0x1F;
  const std::uint32_t fraction = half & 0x3FF;
  if (exponent == 31) return std::bit_cast<float>(sign | 0x7F800000 | fraction << 13);
  const float magnitude = exponent == 0 ? std::ldexp(static_cast<float>(fraction), -24)
                                        : std::ldexp(static_cast<float>(fraction | 0x400), exponent - 25);
  return sign != 0 ? -magnitude : magnitude;
}

Status AlembicSamples::Open(AlembicArchive& archive, const AlembicProperty& property, AlembicSamples& samples) {
  samples = {};
  samples.header_.name = property.name;
  if (property.kind == AlembicProperty::Kind::kCompound) return samples.Named(Status::Corrupt("has no samples"));
  samples.ogawa_ = &archive.ogawa();
  samples.times_ = &archive.time_samplings()[property.time_sampling];
  samples.header_ = property;
  if (property.samples == 0) return Status::Ok();
  std::vector<OgawaRef> children;
  if (Status status = archive.ogawa().ReadGroup(property.group, children); !status.ok()) return samples.Named(status);
  const std::uint32_t stored = property.Stored(property.samples - 1) + 1;
  const std::size_t each = property.kind == AlembicProperty::Kind::kArray ? 2 : 1;
  if (children.size() / each < stored) return samples.Named(Status::Corrupt("fewer samples than it announces"));
  for (std::size_t i = 0; i < stored; ++i) samples.stored_.push_back(children[each * i]);
  samples.samples_ = property.samples;
  // Where each sample has its own time, there may be fewer of these.
  if (samples.times_->acyclic && samples.times_->times.size() < samples.samples_) {
    samples.samples_ = static_cast<std::uint32_t>(samples.times_->times.size());
  }
  return Status::Ok();
}

Status AlembicSamples::Named(const Status& status) const {
  return status.ok() ? status : Status(status.code(), header_.name + ": " + status.message());
}

std::uint32_t AlembicSamples::Stored(std::uint32_t sample) const { return header_.Stored(sample); }

Status AlembicSamples::StoredCount(std::uint32_t stored, std::uint64_t& count) const {
  std::uint64_t bytes = 0;
  if (Status status = ogawa_->DataSize(stored_[stored], bytes); !status.ok()) return Named(status);
  const std::size_t size = SizeOf(header_.pod);
  if (size == 0) return Named(Status::Corrupt("texts in place of numbers"));
  count = bytes < kHashBytes ? 0 : (bytes - kHashBytes) / size;
  const bool whole = bytes == 0 || (bytes >= kHashBytes && (bytes - kHashBytes) % (size * header_.extent) == 0);
  return whole ? Status::Ok() : Named(Status::Corrupt("a sample that is no whole number of elements"));
}

Status AlembicSamples::Bytes(std::uint32_t stored, std::string& bytes) const {
  std::uint64_t size = 0;
  if (Status status = ogawa_->DataSize(stored_[stored], size); !status.ok()) return Named(status);
  bytes.resize(static_cast<std::size_t>(size < kHashBytes ? 0 : size - kHashBytes));
  if (bytes.empty()) return Status::Ok();
  return Named(ogawa_->ReadData(stored_[stored], kHashBytes, bytes.data(), bytes.size()));
}

template <typename Number>
Status AlembicSamples::ReadStored(std::uint32_t stored, std::vector<Number>& numbers) const {
  std::uint64_t count = 0;
  SAC_RETURN_IF_ERROR(StoredCount(stored, count));
  if (std::is_integral_v<Number> && IsFloat(header_.pod)) return Named(Status::Corrupt("no whole numbers"));
  std::string bytes;
  SAC_RETURN_IF_ERROR(Bytes(stored, bytes));
  numbers.resize(static_cast<std::size_t>(count));
  const std::size_t size = SizeOf(header_.pod);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = Load<Number>(header_.pod, bytes.data() + size * i);
  return Status::Ok();
}

template Status AlembicSamples::ReadStored(std::uint32_t, std::vector<float>&) const;
template Status AlembicSamples::ReadStored(std::uint32_t, std::vector<double>&) const;
template Status AlembicSamples::ReadStored(std::uint32_t, std::vector<std::int64_t>&) const;

Status AlembicSamples::ReadText(std::uint32_t sample, std::string& text) const {
  if (header_.pod != AlembicPod::kString) return Named(Status::Corrupt("no text"));
  SAC_RETURN_IF_ERROR(Bytes(Stored(sample), text));
  text.resize(std::min(text.find('\0'), text.size()));
  return Status::Ok();
}

}  // namespace sac

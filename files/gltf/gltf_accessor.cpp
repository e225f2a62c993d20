// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/gltf_accessor.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

namespace sac {
namespace {

constexpr std::uint32_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
                        kFloat = 5126;

std::size_t ComponentsOf(const JsonValue& type) {
  const std::string name = type.String();
  constexpr std::pair<const char*, std::size_t> kTypes[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                            {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
  for (const auto& [known, components] : kTypes) {
    if (name == known) return components;
  }
  ThrowCorrupt(type.place() + ": no type of an accessor");
}

template <typename T>
T Decode(const std::uint8_t* bytes, std::uint32_t type, bool normalized);

template <>
float Decode<float>(const std::uint8_t* bytes, std::uint32_t type, bool normalized) {
  return static_cast<float>(DecodeComponent(bytes, type, normalized));
}

template <>
std::uint32_t Decode<std::uint32_t>(const std::uint8_t* bytes, std::uint32_t type, bool /*normalized*/) {
  return static_cast<std::uint32_t>(DecodeComponent(bytes, type, false));
}

// The bytes of `count` values of `size` bytes each, `stride` apart, that `part` (an accessor, or what is sparse) names.
struct Values {
  const std::uint8_t* data = nullptr;
  std::size_t stride = 0;
};

Values Find(GltfDocument& document, const JsonValue& part, std::uint64_t count, std::size_t size) {
  const JsonValue views = document.root()["bufferViews"];
  const std::size_t view = part["bufferView"].Index(views.size());
  const auto bytes = document.View(view);
  const std::uint64_t offset = part["byteOffset"].Unsigned(document.limits().file_bytes, 0);
  const std::size_t stride = static_cast<std::size_t>(views[view]["byteStride"].Unsigned(255, size));
  if (stride < size) ThrowCorrupt(views[view].place() + ".byteStride: less than a value");
  if (count > 0 && (offset > bytes.size() || (count - 1) * stride + size > bytes.size() - offset)) {
    ThrowCorrupt(part.place() + ": ends after its buffer view of " + std::to_string(bytes.size()) + " bytes");
  }
  return {bytes.data() + (count == 0 ? 0 : offset), stride};
}

template <typename T>
void ReadSparse(GltfDocument& document, const JsonValue& sparse, const GltfAccessor& accessor,
                std::vector<T>& numbers) {
  const std::uint64_t count = sparse["count"].Unsigned(accessor.count);
  const JsonValue indices = sparse["indices"];
  const auto index_type = static_cast<std::uint32_t>(indices["componentType"].Unsigned(6000));
  if (index_type != kUnsignedByte && index_type != kUnsignedShort && index_type != kUnsignedInt) {
    ThrowCorrupt(indices.place() + ".componentType: not that of an index");
  }
  const std::size_t size = ComponentBytes(accessor.component_type);
  const Values places = Find(document, indices, count, ComponentBytes(index_type));
  const Values values = Find(document, sparse["values"], count, size * accessor.components);
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = Decode<std::uint32_t>(places.data + i * places.stride, index_type, false);
    if (place >= accessor.count) ThrowCorrupt(indices.place() + ": " + std::to_string(place) + " is out of range");
    for (std::size_t k = 0; k < accessor.components; ++k) {
      numbers[place * accessor.components + k] =
          Decode<T>(values.data + i * values.stride + k * size, accessor.component_type, accessor.normalized);
    }
  }
}

template <typename T>
std::vector<T> Read(GltfDocument& document, std::size_t index, const GltfAccessor& accessor) {
  const JsonValue json = document.root()["accessors"][index];
  std::vector<T> numbers(static_cast<std::size_t>(accessor.count) * accessor.components);
  if (json["bufferView"]) {
    const std::size_t size = ComponentBytes(accessor.component_type);
    const Values values = Find(document, json, accessor.count, size * accessor.components);
    for (std::size_t i = 0; i < accessor.count; ++i) {
      for (std::size_t k = 0; k < accessor.components; ++k) {
        numbers[i * accessor.components + k] =
            Decode<T>(values.data + i * values.stride + k * size, accessor.component_type, accessor.normalized);
      }
    }
  }
  if (json["sparse"]) ReadSparse(document, json["sparse"], accessor, numbers);
  return numbers;
}

void CheckComponents(const JsonValue& json, const GltfAccessor& accessor, std::size_t components) {
  if (accessor.components != components) {
    ThrowCorrupt(json.place() + ": has " + std::to_string(accessor.components) + " numbers a value, not " +
                 std::to_string(components));
  }
}

}  // namespace

std::size_t ComponentBytes(std::uint32_t component_type) {
  switch (component_type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

double DecodeComponent(const std::uint8_t* bytes, std::uint32_t type, bool normalized) {
  std::uint32_t bits = 0;
  const std::size_t size = ComponentBytes(type);
  for (std::size_t i = 0; i < size; ++i) bits |= std::uint32_t{bytes[i]} << (8 * i);
  double value = bits, largest = 1;
  switch (type) {
    case kFloat:
      return static_cast<double>(std::bit_cast<float>(bits));
    case kByte:
      value = static_cast<double>(static_cast<std::int8_t>(bits));
      largest = 127;
      break;
    case kShort:
      value = static_cast<double>(static_cast<std::int16_t>(bits));
      largest = 32767;
      break;
    case kUnsignedByte:
      largest = 255;
      break;
    case kUnsignedShort:
      largest = 65535;
      break;
    default:
      largest = std::numeric_limits<std::uint32_t>::max();
  }
  return normalized ? std::max(value / largest, -1.0) : value;
}

GltfAccessor DescribeAccessor(const GltfDocument& document, std::size_t index) {
  const JsonValue json = document.root()["accessors"][index];
  GltfAccessor accessor;
  accessor.components = ComponentsOf(json["type"]);
  accessor.component_type = static_cast<std::uint32_t>(json["componentType"].Unsigned(6000));
  if (ComponentBytes(accessor.component_type) == 0) ThrowCorrupt(json.place() + ".componentType: unknown");
  accessor.normalized = json["normalized"].Bool(false);
  accessor.count = json["count"].Unsigned(std::numeric_limits<std::uint32_t>::max());
  if (accessor.count > document.limits().values / accessor.components) {
    ThrowLimit(json.place() + ": " + std::to_string(accessor.count) + " values are more than the limit allows");
  }
  return accessor;
}

std::vector<float> ReadNumbers(GltfDocument& document, std::size_t index, std::size_t components) {
  const GltfAccessor accessor = DescribeAccessor(document, index);
  CheckComponents(document.root()["accessors"][index], accessor, components);
  return Read<float>(document, index, accessor);
}

std::vector<std::uint32_t> ReadIntegers(GltfDocument& document, std::size_t index, std::size_t components) {
  const GltfAccessor accessor = DescribeAccessor(document, index);
  const JsonValue json = document.root()["accessors"][index];
  CheckComponents(json, accessor, components);
  if (accessor.component_type != kUnsignedByte && accessor.component_type != kUnsignedShort &&
      accessor.component_type != kUnsignedInt) {
    ThrowCorrupt(json.place() + ".componentType: not that of an index");
  }
  return Read<std::uint32_t>(document, index, accessor);
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "files/gltf/gltf_document.h"

namespace sac {

// What an accessor says of its values (glTF 2.0, 3.6.2).
struct GltfAccessor {
  std::uint64_t count = 0;
  std::size_t components = 0;    // of a value: 1 for SCALAR, 16 for MAT4
  std::uint32_t component_type;  // 5120 to 5126
  bool normalized = false;
};

// Throws GltfError for broken rules, and where there are more numbers than the limit allows.
GltfAccessor DescribeAccessor(const GltfDocument& document, std::size_t index);

// The size of a component in bytes; 0 for what is no type.
std::size_t ComponentBytes(std::uint32_t component_type);

// All numbers of an accessor, value after value, with those that are sparse (3.6.2.3): integers that are normalized
// become 0..1 or -1..1 (3.6.2.2), others are as they are. The accessor must have `components` a value.
std::vector<float> ReadNumbers(GltfDocument& document, std::size_t index, std::size_t components);

// As ReadNumbers, for integers that mean what they are, such as indices and joints.
std::vector<std::uint32_t> ReadIntegers(GltfDocument& document, std::size_t index, std::size_t components);

// A component of `type`, which `bytes` begin with, as a number.
double DecodeComponent(const std::uint8_t* bytes, std::uint32_t type, bool normalized);

}  // namespace sac

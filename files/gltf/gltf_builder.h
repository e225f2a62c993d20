// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// How numbers of a glTF file are stored.
enum class GltfCompression {
  kNone,       // floats
  kQuantized,  // integers of 8 and 16 bits (KHR_mesh_quantization)
  kMeshopt,    // integers, whose buffer views are compressed as well (EXT_meshopt_compression)
};

// Values of one component type, `components` each, for an accessor.
struct GltfValues {
  std::vector<std::uint8_t> bytes;  // values padded to `stride`
  std::size_t stride = 0;           // bytes
  std::size_t count = 0;
  std::uint32_t component_type = 0;
  std::string type;  // VEC3 and so on
  bool normalized = false;
};

// Floats, `components` (1, 3 or 4) a value.
GltfValues FloatValues(std::span<const float> values, std::size_t components);
GltfValues FloatValues(const std::vector<Vec3f>& values);
// Integers from -32768 to 32767 in 16 bits, or with `bytes` from -127 to 127 in 8, padded to 4 bytes.
GltfValues IntegerValues(const std::vector<std::array<std::int32_t, 3>>& values, bool bytes, bool normalized);

// Collects buffer views, accessors and what uses them, and writes them as .glb or .gltf.
class GltfBuilder {
 public:
  explicit GltfBuilder(GltfCompression compression);

  // The asset. `buffers`, `bufferViews`, `accessors`, `extensionsUsed` are the builder's own.
  nlohmann::json& json() { return json_; }
  void UseExtension(const std::string& name);

  // Adds an accessor and returns its index. `bounds` adds its least and largest values.
  std::size_t Add(const GltfValues& values, bool bounds = false);
  // Adds one whose values are zero but where they are not, where that is smaller.
  std::size_t AddSparse(const GltfValues& values, bool bounds = false);
  // Adds the vertices of triangles.
  std::size_t AddTriangles(const std::vector<Triangle>& triangles, std::size_t vertices);

  std::uint64_t bytes() const { return binary_.size(); }

  // The bytes of the file; kLimit where a .glb would be larger than 4 GiB. The builder is used up.
  Status Finish(bool glb, std::string& file);

 private:
  std::size_t AddView(std::span<const std::uint8_t> bytes, std::size_t stride, bool with_stride);
  std::size_t AddCompressed(std::span<const std::uint8_t> bytes, std::size_t stride, bool with_stride, bool triangles);
  std::size_t Append(std::span<const std::uint8_t> bytes);
  static nlohmann::json Describe(const GltfValues& values, bool bounds);

  GltfCompression compression_;
  nlohmann::json json_;
  std::vector<std::uint8_t> binary_;
  std::size_t uncompressed_ = 0;  // bytes of the buffer that a decoder makes
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/gltf_builder.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <string_view>
#include <utility>

#include "files/gltf/gltf_accessor.h"
#include "sac/version.h"

namespace sac {
namespace {

constexpr std::uint32_t kByte = 5120, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr const char* kMeshopt = "EXT_meshopt_compression";

void Append32(std::uint32_t value, std::vector<std::uint8_t>& bytes) {
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::string Bytes32(std::uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
  return bytes;
}

std::string EncodeBase64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

// Bytes of names that are no UTF-8 are replaced.
std::string Text(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::size_t Components(const GltfValues& values) {
  return values.type == "SCALAR" ? 1 : static_cast<std::size_t>(values.type[3] - '0') * (values.type[0] == 'M' ? 4 : 1);
}

}  // namespace

GltfValues FloatValues(std::span<const float> values, std::size_t components) {
  GltfValues out{{}, 4 * components, values.size() / components, kFloat, "SCALAR", false};
  if (components > 1) out.type = "VEC" + std::to_string(components);
  out.bytes.reserve(4 * values.size());
  for (const float x : values) Append32(std::bit_cast<std::uint32_t>(x), out.bytes);
  return out;
}

GltfValues FloatValues(const std::vector<Vec3f>& values) {
  return FloatValues(values.empty() ? std::span<const float>() : std::span(values[0].data(), 3 * values.size()), 3);
}

GltfValues IntegerValues(const std::vector<std::array<std::int32_t, 3>>& values, bool bytes, bool normalized) {
  const std::size_t stride = bytes ? 4 : 8;
  GltfValues out{{}, stride, values.size(), bytes ? kByte : kShort, "VEC3", normalized};
  out.bytes.reserve(stride * values.size());
  for (const auto& value : values) {
    for (const std::int32_t x : value) {
      out.bytes.push_back(static_cast<std::uint8_t>(x));
      if (!bytes) out.bytes.push_back(static_cast<std::uint8_t>(x >> 8));
    }
    out.bytes.resize((out.bytes.size() + stride - 1) / stride * stride);
  }
  return out;
}

GltfBuilder::GltfBuilder(GltfCompression compression) : compression_(compression) {
  json_["asset"] = {{"version", "2.0"}, {"generator", "sac " SAC_VERSION_STRING}};
  if (compression == GltfCompression::kMeshopt) UseExtension(kMeshopt);
}

void GltfBuilder::UseExtension(const std::string& name) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) json_[list].push_back(name);
}

std::size_t GltfBuilder::Append(std::span<const std::uint8_t> bytes) {
  const std::size_t offset = binary_.size();
  binary_.insert(binary_.end(), bytes.begin(), bytes.end());
  binary_.resize((binary_.size() + 3) / 4 * 4);
  return offset;
}

std::size_t GltfBuilder::AddView(std::span<const std::uint8_t> bytes, std::size_t stride, bool with_stride) {
  if (compression_ == GltfCompression::kMeshopt) return AddCompressed(bytes, stride, with_stride, false);
  json_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", Append(bytes)}, {"byteLength", bytes.size()}});
  if (with_stride) json_["bufferViews"].back()["byteStride"] = stride;
  return json_["bufferViews"].size() - 1;
}

std::size_t GltfBuilder::AddCompressed(std::span<const std::uint8_t> bytes, std::size_t stride, bool with_stride,
                                       bool triangles) {
  std::vector<std::uint8_t> padded(bytes.begin(), bytes.end());
  const std::size_t size = (stride + 3) / 4 * 4;  // of what is compressed as one value
  std::vector<std::uint8_t> code;
  std::size_t count = 0;
  if (triangles) {
    std::vector<std::uint32_t> indices;
    count = bytes.size() / stride;
    for (std::size_t i = 0; i < count; ++i) {
      indices.push_back(static_cast<std::uint32_t>(
          DecodeComponent(bytes.data() + i * stride, stride == 2 ? kUnsignedShort : kUnsignedInt, false)));
    }
    const std::size_t vertices =
        indices.empty() ? 0 : *std::max_element(indices.begin(), indices.end()) + std::size_t{1};
    meshopt_encodeIndexVersion(1);  // the one of the extension
    code.resize(meshopt_encodeIndexBufferBound(count, vertices));
    code.resize(meshopt_encodeIndexBuffer(code.data(), code.size(), indices.data(), count));
  } else {
    padded.resize((padded.size() + size - 1) / size * size);
    count = padded.size() / size;
    meshopt_encodeVertexVersion(0);
    code.resize(meshopt_encodeVertexBufferBound(count, size));
    code.resize(meshopt_encodeVertexBuffer(code.data(), code.size(), padded.data(), count, size));
  }
  const std::size_t step = triangles ? stride : size;
  nlohmann::json view = {{"buffer", 1}, {"byteOffset", uncompressed_}, {"byteLength", count * step}};
  if (with_stride) view["byteStride"] = stride;
  view["extensions"][kMeshopt] = {{"buffer", 0},
                                  {"byteOffset", Append(code)},
                                  {"byteLength", code.size()},
                                  {"byteStride", step},
                                  {"count", count},
                                  {"mode", triangles ? "TRIANGLES" : "ATTRIBUTES"}};
  uncompressed_ += (count * step + 3) / 4 * 4;
  json_["bufferViews"].push_back(std::move(view));
  return json_["bufferViews"].size() - 1;
}

nlohmann::json GltfBuilder::Describe(const GltfValues& values, bool bounds) {
  nlohmann::json accessor = {{"componentType", values.component_type}, {"count", values.count}, {"type", values.type}};
  if (values.normalized) accessor["normalized"] = true;
  if (!bounds) return accessor;
  const std::size_t size = ComponentBytes(values.component_type);
  for (std::size_t k = 0; k < Components(values); ++k) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < values.count; ++i) {
      const double x =
          DecodeComponent(values.bytes.data() + i * values.stride + k * size, values.component_type, false);
      low = std::min(low, x);
      high = std::max(high, x);
    }
    accessor["min"].push_back(low);
    accessor["max"].push_back(high);
  }
  return accessor;
}

std::size_t GltfBuilder::Add(const GltfValues& values, bool bounds) {
  nlohmann::json accessor = Describe(values, bounds);
  const bool vertices = values.type != "SCALAR" && values.type != "MAT4";
  accessor["bufferView"] = AddView(values.bytes, values.stride, vertices);
  json_["accessors"].push_back(std::move(accessor));
  return json_["accessors"].size() - 1;
}

std::size_t GltfBuilder::AddSparse(const GltfValues& values, bool bounds) {
  std::vector<std::uint8_t> indices, kept;
  const std::size_t size = ComponentBytes(values.component_type) * Components(values);
  for (std::size_t i = 0; i < values.count; ++i) {
    const auto value = std::span(values.bytes).subspan(i * values.stride, size);
    if (std::all_of(value.begin(), value.end(), [](std::uint8_t byte) { return byte == 0; })) continue;
    Append32(static_cast<std::uint32_t>(i), indices);
    kept.insert(kept.end(), value.begin(), value.end());
  }
  // What is compressed has runs of zeros for nothing.
  if (compression_ == GltfCompression::kMeshopt || indices.size() + kept.size() >= values.bytes.size()) {
    return Add(values, bounds);
  }
  nlohmann::json accessor = Describe(values, bounds);
  if (!indices.empty()) {  // an accessor without a view is zeros
    const std::size_t places = AddView(indices, 4, false), numbers = AddView(kept, size, false);
    accessor["sparse"] = {{"count", indices.size() / 4},
                          {"indices", {{"bufferView", places}, {"componentType", kUnsignedInt}}},
                          {"values", {{"bufferView", numbers}}}};
  }
  json_["accessors"].push_back(std::move(accessor));
  return json_["accessors"].size() - 1;
}

std::size_t GltfBuilder::AddTriangles(const std::vector<Triangle>& triangles, std::size_t vertices) {
  // The largest number of a type means something else to graphics hardware.
  const std::size_t stride = vertices < 65536 ? 2 : 4;
  std::vector<std::uint8_t> bytes;
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t v : triangle) {
      for (std::size_t i = 0; i < stride; ++i) bytes.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
    }
  }
  const std::size_t view = compression_ == GltfCompression::kMeshopt ? AddCompressed(bytes, stride, false, true)
                                                                     : AddView(bytes, stride, false);
  json_["accessors"].push_back({{"bufferView", view},
                                {"componentType", stride == 2 ? kUnsignedShort : kUnsignedInt},
                                {"count", 3 * triangles.size()},
                                {"type", "SCALAR"}});
  return json_["accessors"].size() - 1;
}

Status GltfBuilder::Finish(bool glb, std::string& file) {
  json_["buffers"].push_back({{"byteLength", binary_.size()}});
  if (compression_ == GltfCompression::kMeshopt) {
    json_["buffers"].push_back({{"byteLength", uncompressed_}, {"extensions", {{kMeshopt, {{"fallback", true}}}}}});
  }
  if (!glb) {
    json_["buffers"][0]["uri"] = "data:application/octet-stream;base64," + EncodeBase64(binary_);
    file = Text(json_);
    return Status::Ok();
  }
  std::string text = Text(json_);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::uint64_t length = 28 + std::uint64_t{text.size()} + binary_.size();
  if (length > std::numeric_limits<std::uint32_t>::max()) {
    return Status::Limit("a .glb holds at most 4 GiB, and this needs " + std::to_string(length) +
                         " bytes; decode fewer --frames, or with --compress meshopt");
  }
  file = "glTF" + Bytes32(2) + Bytes32(static_cast<std::uint32_t>(length)) +
         Bytes32(static_cast<std::uint32_t>(text.size())) + "JSON" + text +
         Bytes32(static_cast<std::uint32_t>(binary_.size())) + std::string("BIN\0", 4);
  file.append(reinterpret_cast<const char*>(binary_.data()), binary_.size());
  return Status::Ok();
}

}  // namespace sac

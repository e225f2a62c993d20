// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/gltf_file.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "files/output_file.h"
#include "format/bytes.h"
#include "geometry/bounding_box.h"

namespace sac::bench {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126, kUnsignedInt = 5125;
constexpr std::uint32_t kIdPart = 4096;

Status WriteFile(const std::string& path, const void* bytes, std::size_t size) {
  OutputFile file;
  SAC_RETURN_IF_ERROR(file.Open(path));
  SAC_RETURN_IF_ERROR(file.Write(bytes, size));
  return file.Commit();
}

// The buffer with its views and accessors; each accessor has a view of its own.
class Buffer {
 public:
  explicit Buffer(json& gltf) : gltf_(gltf) {}

  std::size_t Add(const void* data, std::size_t size, std::size_t count, int component, const char* type) {
    gltf_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}});
    gltf_["accessors"].push_back({{"bufferView", gltf_["bufferViews"].size() - 1},
                                  {"componentType", component},
                                  {"count", count},
                                  {"type", type}});
    bytes_.append(static_cast<const char*>(data), size);
    return gltf_["accessors"].size() - 1;
  }

  // glTF requires the bounds of positions.
  std::size_t AddPositions(const Positions& positions) {
    const std::size_t index = Add(positions.data(), positions.size() * sizeof(Vec3f), positions.size(), kFloat, "VEC3");
    const Box box = BoundingBox(positions);
    gltf_["accessors"][index]["min"] = box.low;
    gltf_["accessors"][index]["max"] = box.high;
    return index;
  }

  std::size_t AddFloats(const std::vector<float>& values, const char* type, std::size_t components) {
    return Add(values.data(), values.size() * sizeof(float), values.size() / components, kFloat, type);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  json& gltf_;
  std::string bytes_;
};

void AddIds(std::size_t vertices, Buffer& buffer, json& gltf) {
  std::vector<float> ids;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    ids.push_back(static_cast<float>(v % kIdPart));
    ids.push_back(static_cast<float>(v / kIdPart));
  }
  gltf["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = buffer.AddFloats(ids, "VEC2", 2);
}

void AddAnimation(const Clip& clip, Buffer& buffer, json& gltf) {
  const std::size_t frames = clip.frames.size();
  std::vector<float> times, weights(frames * (frames - 1));
  for (std::size_t f = 0; f < frames; ++f) times.push_back(static_cast<float>(f) / 30);
  for (std::size_t f = 1; f < frames; ++f) {
    Positions target(clip.vertices());
    for (std::size_t v = 0; v < target.size(); ++v) {
      for (std::size_t a = 0; a < 3; ++a) target[v][a] = clip.frames[f][v][a] - clip.frames[0][v][a];
    }
    gltf["meshes"][0]["primitives"][0]["targets"].push_back({{"POSITION", buffer.AddPositions(target)}});
    gltf["meshes"][0]["weights"].push_back(0);
    weights[f * (frames - 1) + f - 1] = 1;
  }
  const std::size_t input = buffer.AddFloats(times, "SCALAR", 1), output = buffer.AddFloats(weights, "SCALAR", 1);
  gltf["accessors"][input]["min"] = {times.front()};
  gltf["accessors"][input]["max"] = {times.back()};
  gltf["animations"] = {{{"samplers", {{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}}},
                         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
}

double Component(const std::uint8_t* bytes, int type, bool normalized) {
  const auto read = [bytes]<class T>(T value) {
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  };
  switch (type) {
    case 5120:
      return normalized ? std::max(read(std::int8_t{}) / 127, -1.0) : read(std::int8_t{});
    case 5121:
      return read(std::uint8_t{}) / (normalized ? 255 : 1);
    case 5122:
      return normalized ? std::max(read(std::int16_t{}) / 32767, -1.0) : read(std::int16_t{});
    case 5123:
      return read(std::uint16_t{}) / (normalized ? 65535 : 1);
    case kUnsignedInt:
      return read(std::uint32_t{});
    default:
      return read(float{});
  }
}

std::size_t SizeOf(int type) { return type <= 5121 ? 1 : type <= 5123 ? 2 : 4; }

// Decompresses a buffer view of EXT_meshopt_compression with meshoptimizer.
bool Decompress(const json& extension, std::span<const std::uint8_t> code, std::vector<std::uint8_t>& bytes) {
  const std::size_t count = extension.at("count"), stride = extension.at("byteStride");
  const std::string mode = extension.at("mode"), filter = extension.value("filter", "NONE");
  bytes.resize(count * stride);
  int result = -1;
  if (mode == "ATTRIBUTES") result = meshopt_decodeVertexBuffer(bytes.data(), count, stride, code.data(), code.size());
  if (mode == "TRIANGLES") result = meshopt_decodeIndexBuffer(bytes.data(), count, stride, code.data(), code.size());
  if (mode == "INDICES") result = meshopt_decodeIndexSequence(bytes.data(), count, stride, code.data(), code.size());
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count, stride);
  return result == 0 && (filter == "NONE" || filter == "EXPONENTIAL");
}

}  // namespace

Status WriteGltf(const Clip& clip, bool ids, const std::string& path) {
  json gltf{{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  gltf["scenes"] = {{{"nodes", {0}}}};
  gltf["nodes"] = {{{"mesh", 0}}};
  Buffer buffer(gltf);
  const std::size_t indices = buffer.Add(clip.mesh.triangles.data(), clip.mesh.triangles.size() * sizeof(Triangle),
                                         3 * clip.mesh.triangles.size(), kUnsignedInt, "SCALAR");
  gltf["meshes"] = {{{"primitives", {{{"indices", indices}, {"mode", 4}}}}}};
  gltf["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = buffer.AddPositions(clip.frames[0]);
  if (ids) AddIds(clip.vertices(), buffer, gltf);
  if (!ids && clip.frames.size() > 1) AddAnimation(clip, buffer, gltf);
  const std::string name = path.substr(path.rfind('/') + 1) + ".bin";
  gltf["buffers"] = {{{"uri", name}, {"byteLength", buffer.bytes().size()}}};
  SAC_RETURN_IF_ERROR(WriteFile(path + ".bin", buffer.bytes().data(), buffer.bytes().size()));
  const std::string text = gltf.dump();
  return WriteFile(path + ".gltf", text.data(), text.size());
}

Status GlbFile::Open(std::span<const std::uint8_t> bytes) {
  ByteReader in(bytes);
  const std::uint32_t magic = in.U32(), version = in.U32();
  in.U32();
  const std::uint32_t json_size = in.U32();
  in.U32();
  const auto text = in.Bytes(json_size);
  const std::uint32_t binary_size = in.U32();
  in.U32();
  binary_ = in.Bytes(binary_size);
  json_ = json::parse(text.begin(), text.end(), nullptr, false);
  if (!in.ok() || magic != 0x46546c67 || version != 2 || !json_.is_object()) return Status::Corrupt("not a glTF file");
  return Status::Ok();
}

Status GlbFile::BufferView(std::size_t index, std::vector<std::uint8_t>& bytes, std::size_t& stride) const {
  const json& view = json_.at("bufferViews").at(index);
  stride = view.value("byteStride", std::size_t{0});
  const bool compressed = view.contains("extensions");
  const json& place = compressed ? view.at("extensions").at("EXT_meshopt_compression") : view;
  const std::size_t offset = place.value("byteOffset", std::size_t{0}), size = place.at("byteLength");
  if (offset > binary_.size() || size > binary_.size() - offset) return Status::Corrupt("glTF: a view beyond the file");
  const auto part = binary_.subspan(offset, size);
  if (!compressed) {
    bytes.assign(part.begin(), part.end());
    return Status::Ok();
  }
  stride = place.at("byteStride");
  return Decompress(place, part, bytes) ? Status::Ok() : Status::Corrupt("glTF: meshoptimizer cannot decode it");
}

Status GlbFile::Values(std::size_t accessor, std::size_t components, std::vector<double>& values) const {
  const json& a = json_.at("accessors").at(accessor);
  const std::size_t count = a.at("count");
  values.assign(count * components, 0);
  if (!a.contains("bufferView")) return Status::Ok();  // an accessor without a view is all zero
  std::vector<std::uint8_t> bytes;
  std::size_t stride = 0;
  SAC_RETURN_IF_ERROR(BufferView(a.at("bufferView"), bytes, stride));
  const int type = a.at("componentType");
  const std::size_t size = SizeOf(type), offset = a.value("byteOffset", std::size_t{0});
  if (stride == 0) stride = size * components;
  if (count > 0 && offset + (count - 1) * stride + size * components > bytes.size()) {
    return Status::Corrupt("glTF: an accessor beyond its view");
  }
  const bool normalized = a.value("normalized", false);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < components; ++c) {
      values[i * components + c] = Component(bytes.data() + offset + i * stride + c * size, type, normalized);
    }
  }
  return Status::Ok();
}

Status GlbFile::Frames(std::vector<Positions>& frames) const {
  std::vector<double> base;
  SAC_RETURN_IF_ERROR(Values(Primitive().at("attributes").at("POSITION"), 3, base));
  std::vector<std::vector<double>> targets;
  for (const json& target : Primitive().value("targets", json::array())) {
    SAC_RETURN_IF_ERROR(Values(target.at("POSITION"), 3, targets.emplace_back()));
  }
  std::vector<double> weights(targets.size());
  if (json_.contains("animations")) {
    const json& sampler = json_["animations"].at(0).at("samplers").at(0);
    SAC_RETURN_IF_ERROR(Values(sampler.at("output"), 1, weights));
  }
  // gltfpack puts the transform that undoes the quantization into the mesh's node.
  double scale[3] = {1, 1, 1}, translation[3] = {0, 0, 0};
  for (const json& node : json_.at("nodes")) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (node.contains("scale")) scale[a] *= node["scale"].at(a).get<double>();
      if (node.contains("translation")) translation[a] += node["translation"].at(a).get<double>();
    }
  }
  const std::size_t count = targets.empty() ? 1 : weights.size() / targets.size();
  for (std::size_t f = 0; f < count; ++f) {
    std::vector<double> x = base;
    for (std::size_t t = 0; t < targets.size(); ++t) {
      const double weight = weights[f * targets.size() + t];
      for (std::size_t i = 0; weight != 0 && i < x.size(); ++i) x[i] += weight * targets[t].at(i);
    }
    Positions& frame = frames.emplace_back(x.size() / 3);
    for (std::size_t i = 0; i < x.size(); ++i) {
      frame[i / 3][i % 3] = static_cast<float>(scale[i % 3] * x[i] + translation[i % 3]);
    }
  }
  return Status::Ok();
}

Status GlbFile::Triangles(std::vector<Triangle>& triangles) const {
  std::vector<double> indices;
  SAC_RETURN_IF_ERROR(Values(Primitive().at("indices"), 1, indices));
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    triangles.push_back({static_cast<std::uint32_t>(indices[i]), static_cast<std::uint32_t>(indices[i + 1]),
                         static_cast<std::uint32_t>(indices[i + 2])});
  }
  return Status::Ok();
}

Status GlbFile::TextureCoordinates(std::vector<double>& values) const {
  return Values(Primitive().at("attributes").at("TEXCOORD_0"), 2, values);
}

}  // namespace sac::bench

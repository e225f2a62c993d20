// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/draco_primitive.h"

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>

#include <array>
#include <limits>
#include <utility>

namespace sac {
namespace {

// Reads the counts that a Draco mesh begins with, as Draco's decoders do, and throws if it has more than are announced:
// Draco believes them and allocates.
void CheckCounts(std::span<const std::uint8_t> bytes, const std::string& place, std::uint64_t vertices,
                 std::uint64_t triangles) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DracoHeader header{};
  if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) ThrowCorrupt(place + ": no Draco mesh");
  if (header.version_major != 2 || header.version_minor != 2) {
    ThrowUnsupported(place + ": Draco bitstream " + std::to_string(header.version_major) + "." +
                     std::to_string(header.version_minor) + "; 2.2 is read");
  }
  if (header.encoder_type != draco::TRIANGULAR_MESH) ThrowCorrupt(place + ": no Draco mesh");
  if ((header.flags & METADATA_FLAG_MASK) != 0) ThrowUnsupported(place + ": metadata of Draco");
  bool ok = true;
  std::uint32_t faces = 0, points = 0;
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
    std::uint8_t traversal = 0;
    ok = buffer.Decode(&traversal) && draco::DecodeVarint(&points, &buffer) && draco::DecodeVarint(&faces, &buffer);
  } else {
    ok = draco::DecodeVarint(&faces, &buffer) && draco::DecodeVarint(&points, &buffer);
  }
  if (!ok) ThrowCorrupt(place + ": no Draco mesh");
  if (faces > triangles || points > vertices) {
    ThrowCorrupt(place + ": Draco has " + std::to_string(points) + " vertices and " + std::to_string(faces) +
                 " triangles, the accessors say " + std::to_string(vertices) + " and " + std::to_string(triangles));
  }
}

}  // namespace

DracoPrimitive::DracoPrimitive(GltfDocument& document, const JsonValue& extension, std::uint64_t vertices,
                               std::uint64_t triangles)
    : json_(extension) {
  const auto bytes = document.View(extension["bufferView"].Index(document.root()["bufferViews"].size()));
  if (bytes.size() < 12) ThrowCorrupt(extension.place() + ": no Draco mesh");
  CheckCounts(bytes, extension.place(), vertices, triangles);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) ThrowCorrupt(extension.place() + ": Draco says: " + decoded.status().error_msg_string());
  mesh_ = std::move(decoded).value();
  if (mesh_->num_points() != vertices) {
    ThrowCorrupt(extension.place() + ": Draco has " + std::to_string(mesh_->num_points()) +
                 " vertices, the accessors say " + std::to_string(vertices));
  }
}

const draco::PointAttribute& DracoPrimitive::Attribute(const char* name, std::size_t components) const {
  const JsonValue id = json_["attributes"][name];
  const draco::PointAttribute* attribute =
      mesh_->GetAttributeByUniqueId(static_cast<std::uint32_t>(id.Unsigned(std::numeric_limits<std::uint32_t>::max())));
  if (attribute == nullptr) ThrowCorrupt(id.place() + ": Draco has no such attribute");
  if (static_cast<std::size_t>(attribute->num_components()) != components) {
    ThrowCorrupt(id.place() + ": has " + std::to_string(attribute->num_components()) + " numbers a value, not " +
                 std::to_string(components));
  }
  return *attribute;
}

std::vector<float> DracoPrimitive::Numbers(const char* name, std::size_t components, bool normalized) const {
  const draco::PointAttribute& attribute = Attribute(name, components);
  float scale = 1;
  if (normalized) {
    switch (attribute.data_type()) {
      case draco::DT_INT8:
        scale = 1.0F / 127;
        break;
      case draco::DT_UINT8:
        scale = 1.0F / 255;
        break;
      case draco::DT_INT16:
        scale = 1.0F / 32767;
        break;
      case draco::DT_UINT16:
        scale = 1.0F / 65535;
        break;
      default:
        break;
    }
    // Draco's conversion would do the same, if it were told that the values are normalized.
    if (attribute.normalized()) scale = 1;
  }
  std::vector<float> numbers;
  numbers.reserve(mesh_->num_points() * components);
  std::array<float, 16> value{};
  for (draco::PointIndex point(0); point < mesh_->num_points(); ++point) {
    if (!attribute.ConvertValue(attribute.mapped_index(point), static_cast<std::int8_t>(components), value.data())) {
      ThrowCorrupt(json_.place() + ": a value of " + name + " cannot be read");
    }
    for (std::size_t k = 0; k < components; ++k) numbers.push_back(value[k] * scale);
  }
  return numbers;
}

std::vector<std::uint32_t> DracoPrimitive::Integers(const char* name, std::size_t components) const {
  const draco::PointAttribute& attribute = Attribute(name, components);
  std::vector<std::uint32_t> numbers;
  numbers.reserve(mesh_->num_points() * components);
  std::array<std::uint32_t, 16> value{};
  for (draco::PointIndex point(0); point < mesh_->num_points(); ++point) {
    if (!attribute.ConvertValue(attribute.mapped_index(point), static_cast<std::int8_t>(components), value.data())) {
      ThrowCorrupt(json_.place() + ": a value of " + name + " cannot be read");
    }
    numbers.insert(numbers.end(), value.begin(), value.begin() + static_cast<std::ptrdiff_t>(components));
  }
  return numbers;
}

std::vector<Triangle> DracoPrimitive::triangles() const {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh_->num_faces());
  for (draco::FaceIndex f(0); f < mesh_->num_faces(); ++f) {
    Triangle triangle{};
    for (int k = 0; k < 3; ++k) {
      triangle[k] = mesh_->face(f)[k].value();
      if (triangle[k] >= mesh_->num_points()) ThrowCorrupt(json_.place() + ": a vertex is out of range");
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

}  // namespace sac

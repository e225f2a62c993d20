// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/connectivity.h"

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>

#include <array>
#include <memory>

namespace sac::bench {
namespace {

template <class Value>
void SetPositions(draco::Mesh& mesh, draco::DataType type, const std::vector<std::array<Value, 3>>& positions) {
  draco::GeometryAttribute attribute;
  attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, type, false, sizeof(positions[0]), 0);
  const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(positions.size()));
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), positions[v].data());
  }
}

}  // namespace

Status EncodeWithDraco(std::span<const Triangle> triangles, const Positions& positions, int bits,
                       std::vector<std::uint8_t>& bytes) {
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(positions.size()));
  mesh.SetNumFaces(triangles.size());
  for (std::uint32_t j = 0; j < triangles.size(); ++j) {
    const Triangle& t = triangles[j];
    mesh.SetFace(draco::FaceIndex(j), {draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])});
  }
  if (bits > 0) {
    SetPositions(mesh, draco::DT_FLOAT32, positions);
  } else {
    std::vector<std::array<std::int32_t, 3>> integers;
    for (const Vec3f& p : positions) {
      integers.push_back(
          {static_cast<std::int32_t>(p[0]), static_cast<std::int32_t>(p[1]), static_cast<std::int32_t>(p[2])});
    }
    SetPositions(mesh, draco::DT_INT32, integers);
  }
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetSpeedOptions(0, 0);  // strongest compression, as of draco_encoder -cl 10
  if (bits > 0) encoder.SetAttributeQuantization(0, bits);
  draco::EncoderBuffer buffer;
  if (const draco::Status status = encoder.EncodeToBuffer(&buffer); !status.ok()) {
    return Status::Unsupported(std::string("Draco: ") + status.error_msg());
  }
  bytes.assign(buffer.data(), buffer.data() + buffer.size());
  return Status::Ok();
}

Status DecodeWithDraco(std::span<const std::uint8_t> bytes, std::vector<Triangle>& triangles, Positions& positions) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return Status::Corrupt(std::string("Draco: ") + decoded.status().error_msg());
  const draco::Mesh& mesh = *decoded.value();
  const draco::PointAttribute* position = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (position == nullptr) return Status::Corrupt("Draco: no positions");
  positions.resize(mesh.num_points());
  for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
    position->ConvertValue<float, 3>(position->mapped_index(draco::PointIndex(p)), positions[p].data());
  }
  triangles.resize(mesh.num_faces());
  for (std::uint32_t j = 0; j < mesh.num_faces(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) triangles[j][k] = mesh.face(draco::FaceIndex(j))[k].value();
  }
  return Status::Ok();
}

Status OrderOfDraco(std::span<const Triangle> triangles, std::size_t vertices, std::vector<std::uint32_t>& order) {
  // The numbers of the vertices are coded as positions, since Draco's order does not depend on positions. They are
  // split into two parts, which floats hold exactly.
  constexpr std::uint32_t kPart = 1 << 16;
  Positions numbers(vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    numbers[v] = {static_cast<float>(v % kPart), static_cast<float>(v / kPart), 0};
  }
  std::vector<std::uint8_t> bytes;
  SAC_RETURN_IF_ERROR(EncodeWithDraco(triangles, numbers, 0, bytes));
  std::vector<Triangle> ignored;
  SAC_RETURN_IF_ERROR(DecodeWithDraco(bytes, ignored, numbers));
  order.clear();
  for (const Vec3f& p : numbers) {
    order.push_back(static_cast<std::uint32_t>(p[0]) + kPart * static_cast<std::uint32_t>(p[1]));
  }
  return Status::Ok();
}

Status WriteConnectivity(const Clip& clip, ByteWriter& out, Connectivity& connectivity) {
  std::vector<std::uint8_t> bytes;
  Positions ignored;
  // All vertices are at one position, so that positions cost only a few bytes.
  SAC_RETURN_IF_ERROR(EncodeWithDraco(clip.mesh.triangles, Positions(clip.vertices()), 0, bytes));
  SAC_RETURN_IF_ERROR(DecodeWithDraco(bytes, connectivity.triangles, ignored));
  SAC_RETURN_IF_ERROR(OrderOfDraco(clip.mesh.triangles, clip.vertices(), connectivity.order));
  if (connectivity.order.size() != ignored.size()) return Status::Corrupt("Draco: another order for other positions");
  std::vector<bool> coded(clip.vertices());
  for (const std::uint32_t v : connectivity.order) coded[v] = true;
  std::uint32_t more = 0;
  for (std::uint32_t v = 0; v < coded.size(); ++v) {
    if (coded[v]) continue;
    connectivity.order.push_back(v);
    ++more;
  }
  connectivity.vertices = connectivity.order.size();
  out.Varint(static_cast<std::uint32_t>(bytes.size()));
  out.Bytes(bytes);
  out.Varint(more);
  return Status::Ok();
}

Status ReadConnectivity(ByteReader& in, Connectivity& connectivity) {
  const std::uint32_t size = in.Varint();
  Positions positions;
  SAC_RETURN_IF_ERROR(DecodeWithDraco(in.Bytes(size), connectivity.triangles, positions));
  connectivity.vertices = positions.size() + in.Varint();
  return in.ok() ? Status::Ok() : Status::Corrupt("truncated connectivity");
}

}  // namespace sac::bench

// SPDX-License-Identifier: Apache-2.0
#include "codec/draco_mesh.h"

#include <draco/compression/config/decoder_options.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/core/varint_decoding.h>

#include <cstddef>
#include <stdexcept>
#include <string>

#include "format/bytes.h"

namespace sac {
namespace {

// Draco's own decoder of edgebreaker meshes, stopped before the attributes and before each of them, to look at counts
// that Draco would believe whatever they are (spec.md 5.1): a few hundred bytes could otherwise keep it busy for many
// seconds and take gigabytes.
class GuardedDracoDecoder : public draco::MeshEdgebreakerDecoder {
 protected:
  bool CreateAttributesDecoder(std::int32_t index) override;
  bool DecodeAllAttributes() override;

 private:
  // Whether every attribute is one of those that an I-frame may have, once and with a decoder of its own. Finds how
  // each is coded.
  bool ReadDescriptors();
  // Whether the attribute whose data come next in the buffer is predicted in a way whose counts Draco checks.
  bool CheckPrediction(std::uint8_t coding);

  draco::DecoderBuffer descriptors_;  // from there on
  std::vector<std::uint8_t> codings_;
};

using Attribute = draco::GeometryAttribute;

bool IsKnown(const draco::PointAttribute& a) {
  const auto is = [&a](draco::DataType type, int components) {
    return a.data_type() == type && a.num_components() == components;
  };
  switch (a.attribute_type()) {
    case Attribute::POSITION:
      return is(draco::DT_INT32, 3);
    case Attribute::NORMAL:
      return is(draco::DT_FLOAT32, 3);
    case Attribute::COLOR:
      return is(draco::DT_UINT8, 4);
    case Attribute::TEX_COORD:
      return is(draco::DT_FLOAT32, 2);
    case Attribute::GENERIC:
      return is(draco::DT_UINT32, 1);
    default:
      return false;
  }
}

bool GuardedDracoDecoder::CreateAttributesDecoder(std::int32_t index) {
  if (!MeshEdgebreakerDecoder::CreateAttributesDecoder(index)) return false;
  descriptors_ = *buffer();  // those of all decoders follow once all are there
  return true;
}

bool GuardedDracoDecoder::ReadDescriptors() {
  std::size_t seen[Attribute::NAMED_ATTRIBUTES_COUNT] = {};
  for (int i = 0; i < point_cloud()->num_attributes(); ++i) {
    const draco::PointAttribute& attribute = *point_cloud()->attribute(i);
    if (!IsKnown(attribute) || seen[attribute.attribute_type()]++ > 0) return false;
  }
  for (int i = 0; i < num_attributes_decoders(); ++i) {
    std::uint32_t count = 0, id = 0;
    std::uint8_t coding = 0;
    if (!draco::DecodeVarint(&count, &descriptors_) || count != 1) return false;
    descriptors_.Advance(4);  // type, data type, components, normalized
    if (!draco::DecodeVarint(&id, &descriptors_) || !descriptors_.Decode(&coding)) return false;
    codings_.push_back(coding);
  }
  return true;
}

bool GuardedDracoDecoder::CheckPrediction(std::uint8_t coding) {
  if (coding == draco::SEQUENTIAL_ATTRIBUTE_ENCODER_GENERIC) return true;  // values as they are
  draco::DecoderBuffer ahead = *buffer();
  std::int8_t method = 0;
  // Both count orientations: up to 2^31, for which Draco allocates, and loops.
  return ahead.Decode(&method) && method != draco::MESH_PREDICTION_TEX_COORDS_DEPRECATED &&
         method != draco::MESH_PREDICTION_TEX_COORDS_PORTABLE;
}

bool GuardedDracoDecoder::DecodeAllAttributes() {
  if (!ReadDescriptors()) return false;
  for (int i = 0; i < num_attributes_decoders(); ++i) {
    // It is this decoder's own; only the accessor is const.
    auto& decoder = const_cast<draco::AttributesDecoderInterface&>(*attributes_decoder(i));
    if (!CheckPrediction(codings_[static_cast<std::size_t>(i)])) return false;
    if (!decoder.DecodeAttributes(buffer())) return false;
  }
  return true;
}

// The fields before Draco's own data, whose sizes Draco trusts (Draco bitstream specification, sections 4 and 6).
Status CheckDracoHeader(std::span<const std::uint8_t> bytes, const SequenceHeader& header, bool with_ids) {
  ByteReader in(bytes);
  const auto name = in.Bytes(5);
  if (!in.ok() || std::string(name.begin(), name.end()) != "DRACO") return Status::Corrupt("I-frame: not a Draco mesh");
  const std::uint8_t major = in.U8(), minor = in.U8(), type = in.U8(), method = in.U8();
  const std::uint32_t flags = in.U8() | static_cast<std::uint32_t>(in.U8()) << 8;
  if (major != 2 || minor != 2) return Status::Corrupt("I-frame: Draco bitstream other than 2.2");
  if (type != 1 || method != 1 || flags != 0) return Status::Corrupt("I-frame: not a plain Draco edgebreaker mesh");
  in.U8();  // traversal
  const std::uint32_t vertices = in.Varint(), triangles = in.Varint();
  const std::uint8_t attributes = in.U8();  // beside positions; connectivity is allocated for each
  if (!in.ok()) return Status::Corrupt("I-frame: truncated Draco mesh");
  if (triangles > header.triangles) return Status::Corrupt("I-frame: more Draco triangles than the header says");
  if (vertices > 3 * static_cast<std::uint64_t>(triangles)) return Status::Corrupt("I-frame: Draco vertex count");
  if (attributes > (with_ids ? 4 : 3)) return Status::Corrupt("I-frame: more Draco attributes than there are kinds");
  return Status::Ok();
}

// The value of `attribute` at each of its entries.
template <class Value>
std::vector<Value> Values(const draco::PointAttribute& attribute, std::size_t count) {
  std::vector<Value> values(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    attribute.GetValue(draco::AttributeValueIndex(i), values[i].data());
  }
  return values;
}

Status Extract(const draco::Mesh& in, bool with_ids, DracoMesh& out) {
  const draco::PointAttribute* position = in.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (!position || position->data_type() != draco::DT_INT32 || position->num_components() != 3) {
    return Status::Corrupt("I-frame: the Draco mesh has no integer positions");
  }
  out.entries = static_cast<std::uint32_t>(position->size());
  const auto corners = [&](const draco::PointAttribute& attribute, std::vector<Triangle>& triangles) {
    triangles.resize(in.num_faces());
    for (std::uint32_t j = 0; j < in.num_faces(); ++j) {
      for (std::size_t k = 0; k < 3; ++k) {
        triangles[j][k] = attribute.mapped_index(in.face(draco::FaceIndex(j))[k]).value();
        if (triangles[j][k] >= attribute.size()) return false;
      }
    }
    return true;
  };
  if (!corners(*position, out.triangles)) return Status::Corrupt("I-frame: a Draco corner without a position");

  if (const auto* uv = in.GetNamedAttribute(draco::GeometryAttribute::TEX_COORD)) {
    if (uv->data_type() != draco::DT_FLOAT32 || uv->num_components() != 2) {
      return Status::Corrupt("I-frame: texture coordinates of an unknown type");
    }
    out.uvs = Values<std::array<float, 2>>(*uv, uv->size());
    if (!corners(*uv, out.uv_triangles)) return Status::Corrupt("I-frame: a corner without a texture coordinate");
  }
  if (const auto* normal = in.GetNamedAttribute(draco::GeometryAttribute::NORMAL)) {
    if (normal->data_type() != draco::DT_FLOAT32 || normal->num_components() != 3) {
      return Status::Corrupt("I-frame: normals of an unknown type");
    }
    out.normals = Values<Vec3f>(*normal, normal->size());
    if (!corners(*normal, out.normal_triangles)) return Status::Corrupt("I-frame: a corner without a normal");
  }
  if (const auto* color = in.GetNamedAttribute(draco::GeometryAttribute::COLOR)) {
    if (color->data_type() != draco::DT_UINT8 || color->num_components() != 4 ||
        !corners(*color, out.color_triangles)) {
      return Status::Corrupt("I-frame: malformed colours");
    }
    out.colors = Values<std::array<std::uint8_t, 4>>(*color, color->size());
  }
  if (const auto* id = in.GetNamedAttribute(draco::GeometryAttribute::GENERIC)) {
    if (!with_ids || id->data_type() != draco::DT_UINT32 || id->num_components() != 1 || !corners(*id, out.ids)) {
      return Status::Corrupt("I-frame: an unknown attribute");
    }
    const auto values = Values<std::array<std::uint32_t, 1>>(*id, id->size());
    for (Triangle& t : out.ids) {
      for (std::uint32_t& i : t) i = values[i][0];
    }
  }
  return Status::Ok();
}

}  // namespace

Status DecodeDraco(std::span<const std::uint8_t> bytes, const SequenceHeader& header, DracoMesh& mesh, bool with_ids) {
  mesh = {};
  if (bytes.empty()) return Status::Ok();
  SAC_RETURN_IF_ERROR(CheckDracoHeader(bytes, header, with_ids));
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  GuardedDracoDecoder decoder;
  draco::Mesh decoded;
  try {
    const draco::Status status = decoder.Decode(draco::DecoderOptions(), &buffer, &decoded);
    if (!status.ok()) return Status::Corrupt("I-frame: Draco: " + status.error_msg_string());
  } catch (const std::length_error&) {  // of a size that no vector has
    return Status::Corrupt("I-frame: Draco: a size out of range");
  }
  if (buffer.remaining_size() != 0) return Status::Corrupt("I-frame: bytes after the Draco mesh");
  return Extract(decoded, with_ids, mesh);
}

}  // namespace sac

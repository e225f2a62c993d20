// SPDX-License-Identifier: Apache-2.0
#include "codec/draco_decoder.h"

#include <draco/core/varint_decoding.h>

#include <cstddef>

namespace sac {
namespace {

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

}  // namespace

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

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
// Decodes a Draco mesh from standard input and writes the values that spec.md 5.1 uses to standard output, as JSON:
//
//   remaining   number of bytes after the mesh
//   points      number of points
//   faces       three points for each face
//   attributes  for each attribute: type and data_type (Draco's numbers), components, indices (for each point the index
//               of its value), and values in the order in which they are coded, where floats and integers of 32 bits
//               are given by their bits
//
// The exit code is 3 if Draco cannot decode the mesh, which no sanitizer exits with. The program is part of the decoder
// in conformance/decoder and is linked to Draco only, so that this decoder shares no code with sac's own.

#include <draco/compression/decode.h>

#include <cstdint>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

namespace {

void WriteValues(const draco::PointAttribute& attribute) {
  const int components = attribute.num_components();
  const bool bytes = attribute.data_type() == draco::DT_UINT8;
  const bool words = attribute.data_type() == draco::DT_INT32 || attribute.data_type() == draco::DT_FLOAT32;
  std::printf("\"values\":[");
  // Attributes that spec.md 5.1 does not use are listed with their type only.
  const std::size_t count = bytes || words ? attribute.size() : 0;
  std::vector<std::uint8_t> narrow(static_cast<std::size_t>(components));
  std::vector<std::uint32_t> wide(static_cast<std::size_t>(components));
  for (std::size_t i = 0; i < count; ++i) {
    const draco::AttributeValueIndex index(static_cast<std::uint32_t>(i));
    attribute.GetValue(index, bytes ? static_cast<void*>(narrow.data()) : static_cast<void*>(wide.data()));
    std::printf("%s[", i == 0 ? "" : ",");
    for (std::size_t c = 0; c < wide.size(); ++c) {
      std::printf("%s%u", c == 0 ? "" : ",", bytes ? static_cast<unsigned>(narrow[c]) : wide[c]);
    }
    std::printf("]");
  }
  std::printf("]");
}

void WriteAttribute(const draco::PointAttribute& attribute, std::uint32_t points) {
  std::printf("{\"type\":%d,\"data_type\":%d,\"components\":%d,\"indices\":[",
              static_cast<int>(attribute.attribute_type()), static_cast<int>(attribute.data_type()),
              static_cast<int>(attribute.num_components()));
  for (std::uint32_t i = 0; i < points; ++i) {
    std::printf("%s%u", i == 0 ? "" : ",", attribute.mapped_index(draco::PointIndex(i)).value());
  }
  std::printf("],");
  WriteValues(attribute);
  std::printf("}");
}

}  // namespace

int main() {
  const std::string bytes(std::istreambuf_iterator<char>(std::cin), {});
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  const auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) {
    std::fprintf(stderr, "draco_corners: %s\n", decoded.status().error_msg());
    return 3;
  }
  const draco::Mesh& mesh = *decoded.value();
  std::printf("{\"remaining\":%lld,\"points\":%u,\"faces\":[", static_cast<long long>(buffer.remaining_size()),
              mesh.num_points());
  for (std::uint32_t i = 0; i < mesh.num_faces(); ++i) {
    const auto& face = mesh.face(draco::FaceIndex(i));
    std::printf("%s[%u,%u,%u]", i == 0 ? "" : ",", face[0].value(), face[1].value(), face[2].value());
  }
  std::printf("],\"attributes\":[");
  for (int i = 0; i < mesh.num_attributes(); ++i) {
    std::printf("%s", i == 0 ? "" : ",");
    WriteAttribute(*mesh.attribute(i), mesh.num_points());
  }
  std::printf("]}\n");
}

// SPDX-License-Identifier: Apache-2.0
#include "files/gltf/meshopt_view.h"

#include <meshoptimizer.h>

#include <string>

namespace sac {
namespace {

void Filter(const std::string& filter, const std::string& place, std::size_t count, std::size_t stride,
            std::vector<std::uint8_t>& values) {
  if (filter.empty() || filter == "NONE") return;
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
    meshopt_decodeFilterOct(values.data(), count, stride);
  } else if (filter == "QUATERNION" && stride == 8) {
    meshopt_decodeFilterQuat(values.data(), count, stride);
  } else if (filter == "EXPONENTIAL" && stride % 4 == 0) {
    meshopt_decodeFilterExp(values.data(), count, stride);
  } else if (filter == "COLOR") {
    ThrowUnsupported(place + ": the filter COLOR is not read; pack the file with EXT_meshopt_compression");
  } else {
    ThrowCorrupt(place + ": filter " + filter.substr(0, 20) + " of values of " + std::to_string(stride) + " bytes");
  }
}

}  // namespace

std::vector<std::uint8_t> DecodeMeshoptView(const JsonValue& compression, std::span<const std::uint8_t> bytes,
                                            std::uint64_t most) {
  const std::string& place = compression.place();
  const std::size_t stride = static_cast<std::size_t>(compression["byteStride"].Unsigned(256));
  const std::uint64_t count = compression["count"].Unsigned(most);
  const std::string mode = compression["mode"].String(), filter = compression["filter"].String();
  const bool triangles = mode == "TRIANGLES", indices = mode == "INDICES";
  if (!triangles && !indices && mode != "ATTRIBUTES") ThrowCorrupt(place + ": mode " + mode.substr(0, 20));
  const bool fits = triangles || indices ? stride == 2 || stride == 4 : stride > 0 && stride % 4 == 0;
  if (!fits || (triangles && count % 3 != 0)) ThrowCorrupt(place + ": byteStride or count does not fit the mode");
  // A code of attributes takes at least 1 byte for 16 values of a byte, and others a byte for each triangle or index.
  if (count > most / stride || count > 64 * std::uint64_t{bytes.size()} + 1024) {
    ThrowCorrupt(place + ": " + std::to_string(count) + " values in " + std::to_string(bytes.size()) + " bytes");
  }
  std::vector<std::uint8_t> values(static_cast<std::size_t>(count * stride));
  if (count == 0) return values;
  const auto n = static_cast<std::size_t>(count);
  // The first byte of a code has its version in the lower half. Version 1 of attributes came with
  // KHR_meshopt_compression.
  if (mode == "ATTRIBUTES" && !bytes.empty() && bytes[0] == 0xA1) {
    ThrowUnsupported(place +
                     ": attributes in version 1 of their code, which meshoptimizer 0.18 does not know; pack the file "
                     "with EXT_meshopt_compression");
  }
  const int result = triangles ? meshopt_decodeIndexBuffer(values.data(), n, stride, bytes.data(), bytes.size())
                     : indices ? meshopt_decodeIndexSequence(values.data(), n, stride, bytes.data(), bytes.size())
                               : meshopt_decodeVertexBuffer(values.data(), n, stride, bytes.data(), bytes.size());
  if (result != 0) ThrowCorrupt(place + ": its code is broken");
  if (!triangles && !indices) Filter(filter, place, n, stride, values);
  return values;
}

}  // namespace sac

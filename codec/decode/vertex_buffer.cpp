// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/vertex_buffer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

namespace sac {
namespace {

std::size_t BytesOf(VertexFormat format) { return format == VertexFormat::kFloat32 ? 12 : 6; }

Status Check(const VertexBuffer& buffer, std::size_t vertices, const char* name) {
  if (buffer.data == nullptr || vertices == 0) return Status::Ok();
  const std::size_t vertex = BytesOf(buffer.format);
  if (buffer.stride < vertex) {
    return Status::InvalidArgument(std::string(name) + ": a stride of " + std::to_string(buffer.stride) +
                                   " bytes, a vertex has " + std::to_string(vertex));
  }
  if (buffer.size < vertex || (buffer.size - vertex) / buffer.stride < vertices - 1) {
    return Status::InvalidArgument(std::string(name) + ": a buffer of " + std::to_string(buffer.size) +
                                   " bytes does not hold " + std::to_string(vertices) + " vertices");
  }
  return Status::Ok();
}

// Writes `values` to `buffer`. `to_int16` turns the component of a value on an axis into an integer of 16 bits.
template <class ToInt16>
void Fill(const std::vector<Vec3f>& values, const VertexBuffer& buffer, ToInt16&& to_int16) {
  auto* out = static_cast<unsigned char*>(buffer.data);
  for (std::size_t v = 0; v < values.size(); ++v) {
    unsigned char* const vertex = out + v * buffer.stride;
    if (buffer.format == VertexFormat::kFloat32) {
      std::memcpy(vertex, values[v].data(), 12);
      continue;
    }
    for (std::size_t a = 0; a < 3; ++a) {
      const auto x = static_cast<std::uint16_t>(to_int16(static_cast<double>(values[v][a]), a));
      std::memcpy(vertex + 2 * a, &x, 2);
    }
  }
}

}  // namespace

Status CheckBuffers(const FrameBuffers& buffers, std::size_t vertices) {
  SAC_RETURN_IF_ERROR(Check(buffers.positions, vertices, "positions"));
  return Check(buffers.normals, vertices, "normals");
}

void FillBuffers(const Positions& positions, const std::vector<Triangle>& triangles, const Box& box,
                 const FrameBuffers& buffers, NormalField& normals) {
  if (buffers.positions.data != nullptr) {
    std::array<double, 3> scale;
    for (std::size_t a = 0; a < 3; ++a) {
      const double size = box.size()[a];
      scale[a] = size > 0 ? 65535 / size : 0;
    }
    Fill(positions, buffers.positions,
         [&](double x, std::size_t a) { return std::clamp(std::lround((x - box.low[a]) * scale[a]), 0L, 65535L); });
  }
  if (buffers.normals.data != nullptr) {
    Fill(normals.Compute(positions, triangles), buffers.normals,
         [](double x, std::size_t) { return std::lround(x * 32767); });
  }
}

}  // namespace sac

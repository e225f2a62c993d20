#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/status.h"
#include "geometry/bounding_box.h"
#include "geometry/mesh.h"

namespace sac {

enum class VertexFormat {
  kFloat32,  // three floats
  // Three integers of 16 bits. Positions: unsigned, low + (high - low) * x / 65535 of the frame's box. Normals: signed,
  // x / 32767.
  kInt16,
};

// The caller's memory for three components of each vertex: of vertex v at byte v * stride.
struct VertexBuffer {
  void* data = nullptr;    // null: not wanted
  std::size_t size = 0;    // bytes
  std::size_t stride = 0;  // bytes, at least those of a vertex
  VertexFormat format = VertexFormat::kFloat32;
};

struct FrameBuffers {
  VertexBuffer positions;
  VertexBuffer normals;  // of the vertices, area-weighted means of their triangles', of length 1
};

// Whether `buffers` hold so many vertices: kInvalidArgument if not.
Status CheckBuffers(const FrameBuffers& buffers, std::size_t vertices);

// Fills what is wanted. `box`: of the positions.
void FillBuffers(const Positions& positions, const std::vector<Triangle>& triangles, const Box& box,
                 const FrameBuffers& buffers);

}  // namespace sac

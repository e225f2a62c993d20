// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// What a report shows of a clip: a few frames, and of a large mesh only some vertices, so that a page stays small.
struct DisplayMesh {
  std::vector<std::uint32_t> vertices;                  // of the clip, at most kMostDisplayVertices
  std::vector<std::array<std::uint16_t, 3>> triangles;  // indices into `vertices`
  std::vector<std::uint32_t> frames;                    // of the clip, ascending
};

inline constexpr std::size_t kMostDisplayVertices = 12000;

// Of a mesh that has more vertices one is kept in each cell of a grid.
DisplayMesh MakeDisplayMesh(const Mesh& mesh, std::uint32_t frame_count);

// The least and largest coordinates of the frames shown.
struct DisplayBox {
  Vec3f low{}, high{};
};
Status MeasureDisplayBox(const std::string& cache_path, const DisplayMesh& mesh, DisplayBox& box);

// The frames of a cache for display: for each frame, for each vertex, the coordinates as three little endian uint16
// that span twice the box about its centre.
Status SampleShapes(const std::string& cache_path, const DisplayMesh& mesh, const DisplayBox& box, std::string& bytes);

// For each frame, for each vertex, the distance between two caches e as one byte: 0 below 1e-6 of `diagonal`, 255 from
// 1e-1 on, logarithmic between.
Status SampleErrors(const std::string& original_path, const std::string& decoded_path, const DisplayMesh& mesh,
                    double diagonal, std::string& bytes);

}  // namespace sac

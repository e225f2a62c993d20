// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// The part of a clip that a report shows: a few frames and, of a large mesh, a subset of the vertices. It keeps the
// page small.
struct DisplayMesh {
  std::vector<std::uint32_t> vertices;                  // of the clip, at most kMostDisplayVertices
  std::vector<std::array<std::uint16_t, 3>> triangles;  // indices into `vertices`
  std::vector<std::uint32_t> frames;                    // of the clip, ascending
};

inline constexpr std::size_t kMostDisplayVertices = 12000;

// Chooses the vertices and frames to show. Of a mesh with more than kMostDisplayVertices vertices, one vertex is kept
// in each cell of a grid.
DisplayMesh MakeDisplayMesh(const Mesh& mesh, std::uint32_t frame_count);

// The smallest and largest coordinates in the frames shown.
struct DisplayBox {
  Vec3f low{}, high{};
};
Status MeasureDisplayBox(const std::string& cache_path, const DisplayMesh& mesh, DisplayBox& box);

// Reads the shown frames of a cache: for each frame and vertex, the coordinates as three little-endian uint16, whose
// range is twice the box about its centre.
Status SampleShapes(const std::string& cache_path, const DisplayMesh& mesh, const DisplayBox& box, std::string& bytes);

// Computes for each shown frame and vertex the distance between two caches as one byte: 0 below 1e-6 of `diagonal`, 255
// from 1e-1 of it on, logarithmic in between.
Status SampleErrors(const std::string& original_path, const std::string& decoded_path, const DisplayMesh& mesh,
                    double diagonal, std::string& bytes);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/gltf/gltf_document.h"
#include "files/losses.h"
#include "sac/mesh.h"

namespace sac {

// Vertices and triangles of one or, where several share their vertices, more primitives of a mesh (glTF 2.0, 3.7.2).
struct GltfPrimitive {
  std::size_t vertices = 0;
  std::vector<float> positions;     // 3 a vertex
  std::vector<float> normals, uvs;  // 3 and 2 a vertex, or none
  std::vector<float> colors;        // RGBA a vertex, or none
  std::vector<Triangle> triangles;
  std::size_t influences = 0;         // joints of a vertex
  std::vector<std::uint32_t> joints;  // `influences` a vertex
  std::vector<float> weights;         // as many, with the sum 1
  struct Target {
    std::optional<std::size_t> positions, normals;  // accessors of the differences
  };
  std::vector<Target> targets;
};

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
  std::vector<double> weights;  // of the targets, as many as each primitive has
};

// Reads a mesh. `losses` counts what a clip has no place for. Throws GltfError.
GltfMesh ReadGltfMesh(GltfDocument& document, std::size_t index, Losses& losses);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "bench/peers/peer.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac::bench {

// Writes PATH.gltf and PATH.bin: the first frame as a mesh, every other frame as a morph target, and an animation that
// shows them one after the other. With `ids` it writes the first frame alone, with the number v of each vertex as
// texture coordinates (v mod 4096, v / 4096).
Status WriteGltf(const Clip& clip, bool ids, const std::string& path);

// A binary glTF file with one mesh, as gltfpack makes it: quantized, EXT_meshopt_compression.
class GlbFile {
 public:
  Status Open(std::span<const std::uint8_t> bytes);

  // The frames of the animation: for each key the mesh with its morph targets at the key's weights. A file without an
  // animation has one frame, the mesh.
  Status Frames(std::vector<Positions>& frames) const;
  Status Triangles(std::vector<Triangle>& triangles) const;
  // The first set of texture coordinates, as pairs of numbers.
  Status TextureCoordinates(std::vector<double>& values) const;

 private:
  const nlohmann::json& Primitive() const { return json_.at("meshes").at(0).at("primitives").at(0); }
  Status BufferView(std::size_t index, std::vector<std::uint8_t>& bytes, std::size_t& stride) const;
  Status Values(std::size_t accessor, std::size_t components, std::vector<double>& values) const;

  nlohmann::json json_;
  std::span<const std::uint8_t> binary_;
};

}  // namespace sac::bench

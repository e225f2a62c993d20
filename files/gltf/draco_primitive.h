// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "files/gltf/gltf_document.h"
#include "sac/mesh.h"

namespace draco {
class Mesh;
class PointAttribute;
}  // namespace draco

namespace sac {

// A primitive that Draco holds (KHR_draco_mesh_compression).
class DracoPrimitive {
 public:
  // `extension` is the primitive's. Its accessors say that there are `vertices` and `triangles`; Draco's counts are
  // compared with them before it allocates. Throws GltfError.
  DracoPrimitive(GltfDocument& document, const JsonValue& extension, std::uint64_t vertices, std::uint64_t triangles);

  // Whether the attribute of that name is Draco's.
  bool Has(const char* name) const { return json_["attributes"][name].exists(); }
  // Its numbers, `components` a vertex, as ReadNumbers() and ReadIntegers() give them.
  std::vector<float> Numbers(const char* name, std::size_t components, bool normalized) const;
  std::vector<std::uint32_t> Integers(const char* name, std::size_t components) const;

  std::vector<Triangle> triangles() const;

 private:
  const draco::PointAttribute& Attribute(const char* name, std::size_t components) const;

  JsonValue json_;
  std::shared_ptr<draco::Mesh> mesh_;
};

}  // namespace sac

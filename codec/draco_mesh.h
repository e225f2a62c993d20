// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "format/sequence_header.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// A mesh as Draco holds it (spec.md 5.1): entries are the values of its position attribute, which itself says nothing.
// Draco splits vertices that are not manifold into several entries and drops degenerate triangles.
struct DracoMesh {
  std::uint32_t entries = 0;
  std::vector<Triangle> triangles;  // of entries
  std::vector<std::array<float, 2>> uvs;
  std::vector<Triangle> uv_triangles;  // of uvs; empty without texture coordinates
  std::vector<Vec3f> normals;
  std::vector<Triangle> normal_triangles;  // of normals; empty without
  std::vector<std::array<std::uint8_t, 4>> colors;
  std::vector<Triangle> color_triangles;  // of colors; empty without
  std::vector<Triangle> ids;              // per corner, of an encoder's own numbering; empty without
};

// Decodes a Draco stream; sizes are checked against `header` before Draco allocates. kCorrupt when Draco refuses it or
// a rule of spec.md 5.1 is broken. Throws std::bad_alloc when there is no memory. `with_ids`: an encoder's own, whose
// corners have ids.
Status DecodeDraco(std::span<const std::uint8_t> bytes, const SequenceHeader& header, DracoMesh& mesh,
                   bool with_ids = false);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/draco_mesh.h"
#include "codec/shape.h"
#include "format/i_frame_syntax.h"
#include "format/range_coder.h"
#include "format/sequence_header.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// The first frame's mesh with vertices numbered as everywhere after it: by component, by patch, then as Draco gives
// them (spec.md 5.3, 5.4).
struct DecodedIFrame {
  DecodedMesh mesh;
  std::vector<std::array<float, 2>> uvs;
  std::vector<Triangle> uv_triangles;
  std::vector<Vec3f> normals;
  std::vector<Triangle> normal_triangles;  // empty when the normals are those of vertices
  std::vector<std::array<std::uint8_t, 4>> colors;
  std::vector<std::uint32_t> vertex_of_entry;  // Draco's entries, then the loose vertices
  std::vector<Triangle> copy_triangles;        // of copies; empty when there is one of each vertex (spec.md 5.6)
};

// Joins Draco's mesh with what Draco could not code, and decodes positions and copies, with which the range code ends
// (ParseIFrame). Attributes are those of copies. Returns kCorrupt when it does not, or when the counts do not add up to
// the header's.
Status AssembleIFrame(const IFrameSyntax& syntax, const SequenceHeader& header, DracoMesh draco,
                      RangeDecoder& positions, DecodedIFrame& out);
// The same of an I-frame that is yet to be written: positions and copies are those of `syntax`.
Status AssembleIFrame(const IFrameSyntax& syntax, const SequenceHeader& header, DracoMesh draco, DecodedIFrame& out);

// Parses an I-frame with its positions and copies, so that WriteIFrame() can write it again.
Status ReadIFrame(std::span<const std::uint8_t> payload, const SequenceHeader& header, IFrameSyntax& syntax);

}  // namespace sac

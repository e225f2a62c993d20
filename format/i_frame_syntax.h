// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "format/grid_position.h"
#include "format/part_scale.h"
#include "format/range_coder.h"
#include "format/recorded_bins.h"
#include "format/sequence_header.h"
#include "sac/limits.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// States that two points of the Draco mesh are one vertex.
struct Weld {
  std::uint32_t point;  // ascending from weld to weld
  std::uint32_t onto;   // a smaller point
};

// A vertex that no triangle of the Draco mesh uses.
struct LooseVertex {
  GridPosition position;              // on the grid
  std::array<float, 3> normal;        // when the mesh has normals
  std::array<std::uint8_t, 4> color;  // when the mesh has colours
};

// The syntax elements of an I-frame packet (spec.md 5): the mesh as Draco codes it, the parts that Draco cannot code,
// and the parameters of the harmonic basis.
struct IFrameSyntax {
  std::vector<std::uint8_t> mesh;  // a Draco stream; empty when no triangle is left to it
  // The step of the positions of Draco's mesh, and what they are coded by (spec.md 5.5).
  std::uint32_t position_step = 16;  // 1/16 of a grid cell
  std::uint32_t position_slope = 0;  // 1/4096 of the length of edges
  RecordedBins positions;            // and copies, to be written; ParseIFrame() leaves it empty
  std::vector<Weld> welds;
  bool has_normals = false;
  bool has_colors = false;
  std::vector<LooseVertex> loose_vertices;
  std::vector<Triangle> loose_triangles;   // vertices of triangles that Draco drops
  std::vector<std::uint32_t> harmonics;    // per component, each at least 1
  std::vector<PartScale> scales;           // per component; empty when all are the mesh's
  std::uint32_t handles_per_harmonic = 0;  // 0: every vertex is a handle (spec.md 6.4.4)
  std::array<float, 2> fingerprint = {};   // of the harmonics (spec.md 6.6)
  // Per copy of a vertex its index in the input; empty when the input's order is not kept.
  std::vector<std::uint32_t> order;
};

// Whether `order` holds each number below its size once.
bool IsPermutation(const std::vector<std::uint32_t>& order);

std::vector<std::uint8_t> WriteIFrame(const IFrameSyntax& syntax, const SequenceHeader& header);

// Parses what WriteIFrame() writes up to the positions, whose models depend on the mesh, as those of copies do:
// `positions` reads on there, and refers to `payload`. Returns kCorrupt when `payload` breaks a rule of spec.md 5.
Status ParseIFrame(std::span<const std::uint8_t> payload, const SequenceHeader& header, IFrameSyntax& syntax,
                   RangeDecoder& positions);

}  // namespace sac

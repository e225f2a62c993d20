// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/harmonics.h"
#include "format/grid_position.h"
#include "format/plane_layout.h"
#include "format/sequence_header.h"
#include "geometry/components.h"
#include "geometry/laplacian.h"
#include "sac/limits.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// The decoded first frame, M'0: integer positions, and triangles whose components are runs of vertices, and within them
// patches.
struct DecodedMesh {
  std::vector<GridPosition> grid;
  std::vector<Triangle> triangles;
  std::vector<Component> components;
  std::vector<Component> patches;
};

// Everything that both directions derive from the I-frame (spec.md 6).
struct Shape {
  std::vector<Triangle> triangles;
  std::vector<Component> components;
  EdgeList edges;
  PositionMatrix positions;     // of M'0, model units
  Eigen::RowVector3d centre;    // area-weighted mean of M'0
  std::vector<double> weights;  // cotangent weight per edge, of M'0
  Eigen::VectorXd masses;       // area share per vertex, of M'0
  HarmonicBasis basis;
  HarmonicBasis patch_basis;  // empty without a detail plane
  PlaneLayouts layouts;
  double work = 0;           // multiplications that all this took, about
  std::uint64_t memory = 0;  // bytes that it takes, and took meanwhile, about; with one Reconstructor of it
  std::uint64_t reconstructor_memory = 0;  // of each more

  std::size_t vertices() const { return static_cast<std::size_t>(positions.rows()); }
};

// The limits for what an I-frame packet of so many bytes asks for (spec.md 9).
Limits LimitsOfIFrame(const Limits& limits, std::size_t i_frame_bytes);

// How many values of planes a group may have, with what the shape leaves of the memory.
std::uint64_t MaxGroupValues(const Limits& limits, const Shape& shape);

// How many of so many threads may have a Reconstructor each: all of them take no more than half of what the shape
// leaves of the memory, and that off it.
unsigned UseThreads(unsigned threads, const Limits& limits, Shape& shape);

// Builds the shape. `counts`: harmonics per component, one for each component of `mesh`, at most its vertices.
// kLimit when the basis or a frame would take more memory or work than `limits` allows, which is judged before either
// is spent; kCorrupt when counts do not fit or the harmonics do not converge.
Status BuildShape(const SequenceHeader& header, DecodedMesh mesh, std::span<const std::uint32_t> counts,
                  std::uint32_t samples_per_harmonic, const Limits& limits, Shape& shape);

}  // namespace sac

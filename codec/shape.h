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

// The decoded first frame, M'0, on the position grid. Its vertices are ordered such that each connected component is a
// run of consecutive vertices, and each patch is a run within its component.
struct DecodedMesh {
  std::vector<GridPosition> grid;
  std::vector<Triangle> triangles;
  std::vector<Component> components;
  std::vector<Component> patches;  // empty without a detail plane
};

// Everything that both directions derive from the I-frame (spec.md 6).
struct Shape {
  std::vector<Triangle> triangles;
  std::vector<Component> components;
  EdgeList edges;
  PositionMatrix positions;     // of M'0, model units
  Eigen::RowVector3d centre;    // area-weighted mean of M'0, model units
  std::vector<double> weights;  // cotangent weight of each edge in M'0
  Eigen::VectorXd masses;       // area share of each vertex in M'0, sum 1
  HarmonicBasis basis;
  HarmonicBasis patch_basis;  // empty without a detail plane
  PlaneLayouts layouts;
  double work = 0;           // estimated number of multiplications that building the shape took
  std::uint64_t memory = 0;  // estimated bytes at the peak of building the shape, with one Reconstructor for it
  std::uint64_t reconstructor_memory = 0;  // estimated bytes of each further Reconstructor

  std::size_t vertices() const { return static_cast<std::size_t>(positions.rows()); }
};

// The limits for what an I-frame packet of `i_frame_bytes` bytes may ask for: small packets may cause less work
// (spec.md 9).
Limits LimitsOfIFrame(const Limits& limits, std::size_t i_frame_bytes);

// The largest number of coefficients that a group may have: the limit for groups, or as many as fit into the memory
// that the limit leaves beside `shape`, whichever is less.
std::uint64_t MaxGroupValues(const Limits& limits, const Shape& shape);

// Returns how many of `threads` threads may have a Reconstructor each, at least 1. The Reconstructors beyond the first
// may take half of the memory that the limit leaves beside `shape`; what they take is added to shape.memory.
unsigned UseThreads(unsigned threads, const Limits& limits, Shape& shape);

// Builds the shape of the first frame `mesh`. `counts` has the number of harmonics of each component of `mesh`, from 1
// to the component's number of vertices. `samples_per_harmonic` is that of LaplaceProblem.
//
// Returns kLimit when the basis or a frame would take more memory or work than `limits` allows, which is estimated
// before either is spent; kCorrupt when `counts` does not fit the components or the harmonics do not converge.
Status BuildShape(const SequenceHeader& header, DecodedMesh mesh, std::span<const std::uint32_t> counts,
                  std::uint32_t samples_per_harmonic, const Limits& limits, Shape& shape);

}  // namespace sac

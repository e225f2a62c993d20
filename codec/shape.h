// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "codec/blend.h"
#include "codec/blend_system.h"
#include "codec/harmonics.h"
#include "format/grid_position.h"
#include "format/part_scale.h"
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
  // Of each vertex that decoders give out the one of `grid` that it is a copy of, ascending; empty when there is one of
  // each (spec.md 5.6).
  std::vector<std::uint32_t> vertex_of_copy;
  std::vector<PartScale> scales;  // of each component; empty when all are the mesh's
};

// Gives each copy the value of its vertex: `values` has one a vertex before, one a copy afterwards. `vertex_of_copy` is
// that of a DecodedMesh.
template <class Value>
void SpreadToCopies(const std::vector<std::uint32_t>& vertex_of_copy, std::vector<Value>& values) {
  if (vertex_of_copy.empty()) return;
  values.resize(vertex_of_copy.size());
  // From the back: no copy stands before its vertex.
  for (std::size_t i = vertex_of_copy.size(); i-- > 0;) values[i] = values[vertex_of_copy[i]];
}

// The positions of M'0, model units.
PositionMatrix ShapePositions(const SequenceHeader& header, const DecodedMesh& mesh);

// Everything that both directions derive from the I-frame (spec.md 6).
struct Shape {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> vertex_of_copy;  // as in DecodedMesh
  std::vector<Component> components;
  std::vector<double> factors;  // of the steps of displacement and detail in each component; empty: 1 (spec.md 6.5.1)
  EdgeList edges;
  EdgeGraph graph;            // of `edges`
  PositionMatrix positions;   // of M'0, model units
  Eigen::RowVector3d centre;  // area-weighted mean of M'0, model units
  Eigen::VectorXd masses;     // area share of each vertex in M'0, sum 1
  // How much each edge's weight is scaled in this shape and in every other (spec.md 6.4.2).
  std::vector<double> unevenness;
  Blend blend;
  std::unique_ptr<BlendSystem> system;  // of M'0, factorized
  HarmonicBasis basis;                  // in functions of the blend
  // Of each component the values of its harmonics at its handles, handles x harmonics. Empty where each vertex is a
  // handle: there they are the coefficients in `basis`.
  std::vector<Eigen::MatrixXd> at_handles;
  HarmonicBasis patch_basis;  // at vertices; empty without a detail plane
  PlaneLayouts layouts;
  double work = 0;           // estimated number of multiplications that building the shape took
  std::uint64_t memory = 0;  // estimated bytes at the peak of building the shape, with one Reconstructor for it
  std::uint64_t reconstructor_memory = 0;  // estimated bytes of each further Reconstructor

  std::size_t vertices() const { return static_cast<std::size_t>(positions.rows()); }
  const Eigen::MatrixXd& AtHandles(std::size_t c) const {
    return blend.IsAffine(c) ? at_handles[c] : basis.components[c].vectors;
  }
};

// The products of weights and unevenness, edge by edge.
std::vector<double> Product(std::span<const double> weights, std::span<const double> unevenness);

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
// to the component's number of vertices. `handles_per_harmonic` is the number of handles for each of them; 0: every
// vertex is a handle.
//
// Returns kLimit when the basis or a frame would take more memory or work than `limits` allows, which is estimated
// before either is spent; kCorrupt when `counts` does not fit the components, the harmonics do not converge or the
// linear system is singular.
Status BuildShape(const SequenceHeader& header, DecodedMesh mesh, std::span<const std::uint32_t> counts,
                  std::uint32_t handles_per_harmonic, const Limits& limits, Shape& shape);

}  // namespace sac

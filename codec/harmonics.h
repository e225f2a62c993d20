// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/blend.h"
#include "codec/blend_system.h"
#include "format/grid_position.h"
#include "format/plane_layout.h"
#include "geometry/components.h"
#include "geometry/edges.h"
#include "sac/status.h"

namespace sac {

// The manifold harmonics of one component or one patch: the eigenfunctions of its Laplace-Beltrami operator with the
// smallest eigenvalues (Vallet and Levy 2008), as coefficients of functions: those of the blend, or each vertex's own.
struct ComponentHarmonics {
  Component component;          // its vertices
  Component functions;          // the functions that the rows of `vectors` belong to
  Eigen::MatrixXd vectors;      // functions x harmonics; each harmonic has a mass-weighted mean square of 1
  Eigen::VectorXd eigenvalues;  // ascending
  Eigen::VectorXd generic;      // of each function the sum over vertices v of G(7 v) times its value (spec.md 6.6)
};

struct HarmonicBasis {
  std::vector<ComponentHarmonics> components;
  std::vector<HarmonicIndex> order;  // the harmonic of each row of a plane
};

// Two numbers by which a decoder finds that its harmonics are not the encoder's: the sum of the components'
// eigenvalues, and a fixed generic bilinear form of all vectors of components and patches (spec.md 6.6).
std::array<float, 2> Fingerprint(const HarmonicBasis& components, const HarmonicBasis& patches);

// Whether two fingerprints belong to the same harmonics, allowing for the rounding errors of different machines.
bool SameFingerprint(const std::array<float, 2>& a, const std::array<float, 2>& b);

// By how much the weight of each edge is scaled within the component or patch that it is in (spec.md 6.4.2), which
// splits the multiple eigenvalues of symmetric shapes. 1 for edges between two of `runs`.
std::vector<double> Unevenness(const EdgeList& edges, std::span<const GridPosition> grid,
                               std::span<const Component> runs);

// The estimated number of multiplications to compute `harmonics` harmonics of a component of `vertices` vertices and
// `handles` handles.
double HarmonicsWork(double vertices, double harmonics, double handles);

// The estimated peak number of bytes of the same computation, its result included.
double HarmonicsMemory(double vertices, double harmonics, double handles);

// The eigenvalue problem of the Laplace-Beltrami operator of a mesh. It is solved separately for each component, or for
// each patch. Everything that it refers to must outlive it.
struct LaplaceProblem {
  const EdgeList& edges;
  std::span<const double> weights;        // of each edge
  const Eigen::VectorXd& masses;          // mass of each vertex: its share of the area, or 1 for patches
  std::span<const Component> components;  // components or patches
  std::span<const std::uint32_t> counts;  // harmonics wanted of each component, 1 to its number of vertices
};

// Computes the exact harmonics (spec.md 6.4). Returns kCorrupt when an eigenvalue problem does not converge.
Status ComputeHarmonics(const LaplaceProblem& problem, HarmonicBasis& basis);

// Computes the harmonics of a blend as spec.md 6.4.6 defines them. `system` belongs to M'0, `graph` to its mesh;
// `masses` and `counts` are those of LaplaceProblem. Returns kCorrupt when an eigenvalue problem does not converge.
Status ComputeBlendHarmonics(const Blend& blend, const BlendSystem& system, const EdgeGraph& graph,
                             std::span<const Component> components, const Eigen::VectorXd& masses,
                             std::span<const std::uint32_t> counts, HarmonicBasis& basis);

}  // namespace sac

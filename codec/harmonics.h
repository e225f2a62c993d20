// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "format/grid_position.h"
#include "format/harmonic_order.h"
#include "geometry/components.h"
#include "geometry/laplacian.h"
#include "sac/status.h"

namespace sac {

// The manifold harmonics of one component or one patch: the eigenfunctions of its Laplace-Beltrami operator with the
// smallest eigenvalues (Vallet and Levy 2008).
struct ComponentHarmonics {
  Component component;
  Eigen::MatrixXd vectors;      // vertices x harmonics, each column with a mass-weighted mean square of 1
  Eigen::VectorXd eigenvalues;  // ascending
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

// The estimated number of multiplications to compute `harmonics` harmonics of a component of `vertices` vertices.
// `samples` is the number of samples of the reduced basis, 0 for the exact one.
double HarmonicsWork(double vertices, double harmonics, double samples);

// The estimated peak number of bytes of the same computation, its result included.
double HarmonicsMemory(double vertices, double harmonics, double samples);

// Work and memory that a component may take beyond the estimates of HarmonicsWork() and HarmonicsMemory(). The
// estimates count the radial functions of a surface; where vertices fill a volume, more functions reach each vertex.
struct Spare {
  double work = std::numeric_limits<double>::infinity();    // multiplications
  double memory = std::numeric_limits<double>::infinity();  // bytes
};

// The eigenvalue problem of the Laplace-Beltrami operator of a mesh. It is solved separately for each component, or for
// each patch. Everything that it refers to must outlive it.
struct LaplaceProblem {
  const EdgeList& edges;
  std::span<const double> weights;         // cotangent weight of each edge in the decoded first frame
  const Eigen::VectorXd& masses;           // mass of each vertex: its share of the area, or 1 for patches
  std::span<const GridPosition> grid;      // position of each vertex
  std::span<const Component> components;   // components or patches
  std::span<const std::uint32_t> counts;   // harmonics wanted of each component, 1 to its number of vertices
  std::uint32_t samples_per_harmonic = 0;  // samples of the reduced basis for each harmonic; 0: the exact basis
};

// Computes the basis as spec.md 6.4 defines it. Returns kCorrupt when an eigenvalue problem does not converge and
// kLimit when it takes more than its estimate and `spare` together.
Status ComputeHarmonics(const LaplaceProblem& problem, const Spare& spare, HarmonicBasis& basis);

}  // namespace sac

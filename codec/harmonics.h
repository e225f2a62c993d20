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

// The manifold harmonics of one component, or of a patch: eigenfunctions of its Laplace-Beltrami operator (Vallet and
// Levy 2008).
struct ComponentHarmonics {
  Component component;
  Eigen::MatrixXd vectors;      // count x harmonics, unit mean square
  Eigen::VectorXd eigenvalues;  // ascending
};

struct HarmonicBasis {
  std::vector<ComponentHarmonics> components;
  std::vector<HarmonicIndex> order;  // of a plane's rows
};

// Two numbers that differ when the harmonics of components or patches do: the sum of the components' eigenvalues, and a
// fixed generic bilinear form of all vectors (spec.md 6.6).
std::array<float, 2> Fingerprint(const HarmonicBasis& components, const HarmonicBasis& patches);

// Whether two fingerprints are of the same harmonics, as computed by different machines.
bool SameFingerprint(const std::array<float, 2>& a, const std::array<float, 2>& b);

// Multiplications that the harmonics of a component of so many vertices take, about. `samples`: of the reduced basis.
double HarmonicsWork(double vertices, double harmonics, double samples);

// Bytes that they take, and their computation with them, at most, about.
double HarmonicsMemory(double vertices, double harmonics, double samples);

// What is left for what HarmonicsWork() and HarmonicsMemory() do not count: radial functions of vertices that fill a
// volume, which more of them reach than on a surface.
struct Spare {
  double work = std::numeric_limits<double>::infinity();
  double memory = std::numeric_limits<double>::infinity();
};

// The eigenvalue problem of the Laplace-Beltrami operator of a mesh, which is solved for each of its components, or for
// each patch, apart. What it refers to must outlive it.
struct LaplaceProblem {
  const EdgeList& edges;
  std::span<const double> weights;         // cotangent weight per edge, of the decoded first frame
  const Eigen::VectorXd& masses;           // area share per vertex, of the decoded first frame
  std::span<const GridPosition> grid;      // per vertex
  std::span<const Component> components;   // or patches
  std::span<const std::uint32_t> counts;   // harmonics wanted per component, 1 to its number of vertices
  std::uint32_t samples_per_harmonic = 0;  // of the reduced basis; 0: the exact one
};

// Computes the basis as spec.md 6.4 defines it. kCorrupt when an eigenvalue problem does not converge, kLimit when it
// takes more than `spare` has.
Status ComputeHarmonics(const LaplaceProblem& problem, const Spare& spare, HarmonicBasis& basis);

}  // namespace sac

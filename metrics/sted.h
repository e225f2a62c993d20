// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "metrics/rim_graph.h"
#include "sac/mesh.h"

namespace sac {

// The spatio-temporal edge difference of Vasa and Skala, "A perception correlated comparison method for dynamic
// meshes", IEEE TVCG 17(2), 2011, with the constants that its author's tool uses:
//
//   STED = sqrt(STEDs^2 + kStedWeight^2 STEDt^2).
inline constexpr double kStedWeight = 9.144e-5;
inline constexpr double kStedTimeStep = 3e-4;  // the length that a frame's pause counts as, in diameters
inline constexpr std::size_t kStedWindow = 5;  // frame steps on either side of a moment

// STEDs: the mean over all vertices and frames of the standard deviation of r = (l - l') / l, weighted by l, over the
// edges that touch the vertex or one of its neighbours (topological distance 1); l and l' are an edge's original and
// decoded lengths. Edges of no length in the original have no weight. A vertex without such edges counts as 0.
//
// Time and memory are linear in the edges, whatever the degrees of the vertices.
class SpatialSted {
 public:
  // Every index of `triangles` is below `vertices`.
  SpatialSted(const std::vector<Triangle>& triangles, std::size_t vertices);

  // Takes the next frame; both have `vertices` positions.
  void Add(const Positions& original, const Positions& decoded);

  double Value() const;  // 0 without frames or vertices

 private:
  // The weight, the weighted mean and the weighted sum of squares about that mean of r over a set of edges.
  struct Moments {
    double weight, mean, squares;
  };
  void MeasureEdges(const Positions& original, const Positions& decoded);
  Moments OfSpokes(std::size_t v) const;
  double DeviationNear(std::size_t v) const;

  RimGraph graph_;
  std::vector<double> length_, change_;  // per edge: l, r
  std::vector<Moments> spokes_;          // per vertex, over the edges at the vertex
  double sum_ = 0;
  std::size_t frames_ = 0;
};

// STEDt: the mean over all vertices and steps from frame to frame of |s' - s| / m. A step of length d has the speed
// s = sqrt(d^2 / D^2 + kStedTimeStep^2), D the diameter of the original's first frame; m is the mean of the original's
// speed over the steps from kStedWindow - 1 before to kStedWindow after, as far as they exist.
//
// A first frame that is a single point has no diameter; lengths are then measured against one model unit.
class TemporalSted {
 public:
  explicit TemporalSted(std::size_t vertices);

  void Add(const Positions& original, const Positions& decoded);

  double Value() const;  // 0 with fewer than two frames or without vertices

 private:
  static constexpr std::size_t kRing = 2 * kStedWindow;
  // The last kRing steps of one vertex; step i stands at i % kRing.
  struct History {
    double speed[kRing], difference[kRing];
  };
  // Sum over the vertices of step i's term, when the steps before `end` are known.
  double StepSum(std::size_t i, std::size_t end) const;

  Positions last_original_, last_decoded_;
  std::vector<History> history_;
  double inverse_diameter2_ = 0;
  double sum_ = 0;  // of the steps whose window is complete
  std::size_t frames_ = 0;
};

}  // namespace sac

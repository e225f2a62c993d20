// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "metrics/kg.h"
#include "metrics/part_error.h"
#include "metrics/seam_gap.h"
#include "metrics/sted.h"
#include "sac/distortion.h"
#include "sac/mesh.h"

namespace sac {

// Measures an animation frame by frame. Memory does not depend on the number of frames: about 390 bytes a vertex of a
// closed surface.
//
//   ErrorMeter meter(mesh.triangles, mesh.positions.size());
//   while (...) meter.Add(original_frame, decoded_frame);
//   DistortionMetrics m = meter.Result();
//
// Of a clip whose mesh changes, KG is that of all frames; of STED's parts the squares are averaged over the frames; all
// others are the largest.
//
// Positions that are not finite make the results that they enter NaN or infinite.
class ErrorMeter {
 public:
  // Every index of `triangles` must be below `vertices`. Degenerate and duplicate triangles, isolated vertices and a
  // mesh without triangles are fine.
  ErrorMeter(std::vector<Triangle> triangles, std::size_t vertices);

  // Goes on with frames of another mesh.
  void BeginMesh(std::vector<Triangle> triangles, std::size_t vertices);

  // Takes the next frame, in display order. Both must have `vertices` positions, in the same vertex order.
  void Add(const Positions& original, const Positions& decoded);

  // The metrics of the frames so far, all zeros before the first.
  DistortionMetrics Result() const;

 private:
  DistortionMetrics OfThisMesh() const;

  DistortionMetrics before_;  // of the meshes before this, but for KG and STED
  KgError kg_;
  SpatialSted spatial_;
  TemporalSted temporal_;
  SeamGap seam_gap_;
  PartError parts_;
  double max_error2_ = 0;
  std::size_t frames_ = 0;  // of this mesh
};

}  // namespace sac

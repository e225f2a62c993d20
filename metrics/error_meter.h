#pragma once

#include <cstddef>
#include <vector>

#include "metrics/kg.h"
#include "metrics/sted.h"
#include "sac/mesh.h"

namespace sac {

// The distortion of a decoded animation against its original.
struct DistortionMetrics {
  double kg = 0;         // percent, see KgError; infinite only if the original has no spread: write null in JSON
  double sted = 0;       // sqrt(sted_s^2 + kStedWeight^2 sted_t^2), no unit
  double sted_s = 0;     // spatial part, see SpatialSted
  double sted_t = 0;     // temporal part, see TemporalSted; 0 with a single frame
  double max_error = 0;  // largest distance between a vertex and its decoded position, in model units
  std::size_t frames = 0;
};

// Measures an animation frame by frame. Memory does not depend on the number of frames: about 370 bytes a vertex of a
// closed surface.
//
//   ErrorMeter meter(mesh.triangles, mesh.positions.size());
//   while (...) meter.Add(original_frame, decoded_frame);
//   DistortionMetrics m = meter.Result();
//
// Positions that are not finite make the results that they enter NaN or infinite.
class ErrorMeter {
 public:
  // Every index of `triangles` must be below `vertices`. Degenerate and duplicate triangles, isolated vertices and a
  // mesh without triangles are fine.
  ErrorMeter(std::vector<Triangle> triangles, std::size_t vertices);

  // Takes the next frame, in display order. Both must have `vertices` positions, in the same vertex order.
  void Add(const Positions& original, const Positions& decoded);

  // The metrics of the frames so far, all zeros before the first.
  DistortionMetrics Result() const;

 private:
  KgError kg_;
  SpatialSted spatial_;
  TemporalSted temporal_;
  double max_error2_ = 0;
  std::size_t frames_ = 0;
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "geometry/laplacian.h"
#include "sac/mesh.h"

namespace sac {

// The largest magnitude of a coordinate.
double LargestCoordinate(const Positions& positions);

// The smallest bound on the error that an encoder promises for a clip of this first frame: from about half the spacing
// of its largest floats on decoded floats are the input's own, and there is nothing left to promise.
double LeastMaxError(const Positions& first_frame);

// The step of the correction plane that holds `max_error`. What half a step on each axis leaves is kept below the
// bound, so that the rounding of decoded positions to floats has room: for coordinates 16 times as large as the first
// frame's, and for any where the bound is near the precision of floats.
double CorrectionStep(double max_error, const Positions& first_frame);

// The distance to `exact`, a float on each axis, of exact + error rounded to floats, at most. 0 where that rounds back.
double DistanceAfterRounding(const Eigen::RowVector3d& exact, const Eigen::RowVector3d& error);

// Steps and bits that make a bound on the error cheap, found by measurement (docs/rate-control.md).
struct BoundedSettings {
  double motion_step;        // radians and strain
  double displacement_step;  // model units
  double detail_step;        // model units
  double position_bits;
  double harmonics;
};
BoundedSettings SettingsOfMaxError(double max_error, const Positions& first_frame);

}  // namespace sac

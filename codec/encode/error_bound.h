// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "codec/encode/operating_point.h"
#include "geometry/laplacian.h"
#include "sac/mesh.h"

namespace sac {

// The largest magnitude of a coordinate.
double LargestCoordinate(const Positions& positions);

// The smallest bound on the error, model units, that an encoder accepts for a clip with this first frame. It is about
// half the spacing of floats at the largest coordinate; below that, decoded floats would have to equal the input's.
double LeastMaxError(const Positions& first_frame);

// The step of the correction plane, model units, that keeps every vertex within `max_error`. The error of half a step
// on each axis is smaller than the bound, which leaves room for the rounding of decoded positions to floats. The room
// suffices for coordinates up to 16 times as large as the first frame's, and for any where the bound is near the
// precision of floats.
double CorrectionStep(double max_error, const Positions& first_frame);

// An upper bound on the distance between `exact`, whose coordinates are floats, and exact + error rounded to floats. It
// is 0 where the sum rounds back to `exact`.
double DistanceAfterRounding(const Eigen::RowVector3d& exact, const Eigen::RowVector3d& error);

// The settings with which the bound `max_error`, model units, takes few bytes, found by measurement
// (docs/rate-control.md). `rms` is the first frame's RMS radius, model units.
OperatingPoint PointOfMaxError(double max_error, const Positions& first_frame, double rms);

}  // namespace sac

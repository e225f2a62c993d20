// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/error_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/bounding_box.h"

namespace sac {
namespace {

constexpr double kHalfUlp = 0x1p-24;  // half the spacing of floats, relative to their magnitude

// Half the distance from a float to the next one towards zero. The next one away from zero is never nearer.
double HalfSpacingBelow(double magnitude) {
  const auto x = static_cast<float>(magnitude);
  return (static_cast<double>(x) - static_cast<double>(std::nextafter(x, 0.0f))) / 2;
}

// The most that rounding to a float changes a number whose magnitude is at most `magnitude`.
double LargestRounding(double magnitude) {
  const auto x = static_cast<float>(magnitude);
  return (static_cast<double>(std::nextafter(x, std::numeric_limits<float>::infinity())) - static_cast<double>(x)) / 2;
}

}  // namespace

double LargestCoordinate(const Positions& positions) {
  double largest = 0;
  for (const Vec3f& p : positions) {
    for (const float x : p) largest = std::max(largest, std::abs(static_cast<double>(x)));
  }
  return largest;
}

double LeastMaxError(const Positions& first_frame) {
  // The bound is at least 1e-30, so that a tenth of it is still a normal float.
  return std::max(LargestCoordinate(first_frame) * kHalfUlp / 2, 1e-30);
}

double CorrectionStep(double max_error, const Positions& first_frame) {
  const double rounding = std::sqrt(3.0) * LargestCoordinate(first_frame) * kHalfUlp;
  const double left =
      max_error < 64 * rounding ? 0.5 * max_error : std::min(max_error - 16 * rounding, 0.95 * max_error);
  return 0.999 * left * 2 / std::sqrt(3.0);
}

double DistanceAfterRounding(const Eigen::RowVector3d& exact, const Eigen::RowVector3d& error) {
  double squares = 0;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double e = std::abs(error[a]);
    if (e == 0 || e < 0.99 * HalfSpacingBelow(std::abs(exact[a]))) continue;
    const double off = e + LargestRounding(std::abs(exact[a]) + e);
    squares += off * off;
  }
  return std::sqrt(squares);
}

OperatingPoint PointOfMaxError(double max_error, const Positions& first_frame, double rms) {
  double diagonal = BoundingBox(first_frame).diagonal();
  if (diagonal == 0) diagonal = std::max(LargestCoordinate(first_frame), max_error);  // a single point
  const double bound = max_error / diagonal;
  // A smaller bound needs more detail, and finer motion and displacement steps then save bytes, within limits.
  const double finer = std::clamp(std::pow(bound / 1e-3, 0.35), 0.1, 3.0);
  // With this step nearly all vertices stay within the bound without a correction. Where detail is sparse, a coarser
  // step is enough.
  double detail = max_error * 0.85 * std::max(1.0, std::sqrt(bound / 3e-3));
  // A residual is at most 2^20 steps, so detail with a finer step could not reach across the shape. Corrections code
  // the remaining error.
  if (bound < 1e-6) detail = std::max(detail, 2.7e-5 * diagonal);
  const double bits = std::clamp(std::ceil(0.5 - std::log2(bound)), 7.0, 20.0);
  return {0.02 * finer, 1.3e-4 * diagonal * finer / rms, detail / rms, bits, 200};
}

}  // namespace sac

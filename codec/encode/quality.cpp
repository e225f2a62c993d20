// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sac {
namespace {

// What one quality stands for.
struct Row {
  double quality;
  OperatingPoint point;
};

// docs/quality.md has the rates and errors of these rows. Detail begins where finer motion and displacement no longer
// reduce the error.
constexpr std::array<Row, 11> kTable = {{
    {0, {0.15, 0.008, 0, 7.4, 200}},
    {10, {0.08, 0.004, 0, 8.4, 200}},
    {25, {0.05, 0.0022, 0, 9.3, 200}},
    {50, {0.03, 0.0012, 0, 10.3, 200}},
    {60, {0.02, 0.0006, 0, 11, 200}},
    {65, {0.018, 0.00035, 0, 11.25, 350}},
    {70, {0.015, 0.0002, 0, 11.5, 600}},
    {kDetailQuality, {0.015, 0.00012, 0, 11.7, 750}},
    {80, {0.02, 0.0005, 0.005, 12, 200}},
    {90, {0.02, 0.0005, 0.002, 12.6, 200}},
    {100, {0.015, 0.0004, 0.0004, 14.4, 200}},
}};

// Between a row without detail and one with it, detail begins at this fraction of the way: before it, the step would be
// so coarse that nothing would be coded.
constexpr double kLeastDetail = 0.02;

// The time to start grows with vertices x harmonics^2, the memory with vertices x harmonics.
constexpr double kLeastCap = 200, kVerticesPerHarmonic = 9, kMaxBasisValues = 12e6, kMaxHarmonics = 1000;

OperatingPoint Between(const Row& low, const Row& high, double quality) {
  const double t = (quality - low.quality) / (high.quality - low.quality);
  // Steps are interpolated by their logarithms.
  const auto between = [t](double a, double b) {
    if (a == 0) return b == 0 || t < kLeastDetail ? 0.0 : b / t;  // detail fades in from an infinite step
    return a * std::pow(b / a, t);
  };
  const OperatingPoint &a = low.point, &b = high.point;
  return {between(a.motion_step, b.motion_step), between(a.displacement_step, b.displacement_step),
          between(a.detail_step, b.detail_step), a.position_bits + t * (b.position_bits - a.position_bits),
          between(a.harmonics, b.harmonics)};
}

OperatingPoint Interpolate(const std::vector<Row>& rows, double quality) {
  std::size_t i = 1;
  while (i + 1 < rows.size() && rows[i].quality < quality) ++i;
  return Between(rows[i - 1], rows[i], quality);
}

}  // namespace

HarmonicLimits HarmonicLimitsOf(std::uint32_t vertices) {
  const double n = vertices;
  return {std::max(kLeastCap, n / kVerticesPerHarmonic),
          std::max(kLeastCap, std::min(kMaxBasisValues / n, kMaxHarmonics))};
}

OperatingPoint PointOfQuality(double quality, const HarmonicLimits& limits) {
  std::vector<Row> rows;
  for (const Row& row : kTable) {
    if (row.point.harmonics <= std::max(kLeastCap, limits.useful)) rows.push_back(row);
  }
  OperatingPoint point = Interpolate(rows, quality);
  point.harmonics = std::min(point.harmonics, std::max(kLeastCap, limits.quick));
  return point;
}

OperatingPoint SmoothPointOfQuality(double quality, double max_harmonics) {
  std::vector<Row> rows;
  for (const Row& row : kTable) {
    if (row.point.detail_step == 0) rows.push_back(row);
  }
  OperatingPoint point = Interpolate(rows, quality);
  point.harmonics = std::min(point.harmonics, std::max(kLeastCap, max_harmonics));
  return point;
}

}  // namespace sac

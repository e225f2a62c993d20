// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "codec/encode/edge_length.h"
#include "geometry/bounding_box.h"

namespace sac {
namespace {

// What one quality stands for.
struct Row {
  double quality;
  OperatingPoint point;
};

// docs/quality.md has the rates and errors of these rows. Detail steps are in edges of median length here. A coarse
// detail plane raises STED, because it codes little but steps from patch to patch; so detail begins at once with a step
// that lowers it, and the table has two rows there.
constexpr std::array<Row, 13> kTable = {{
    {0, {0.15, 0.008, 0, 7.4, 200}},
    {10, {0.08, 0.004, 0, 8.4, 200}},
    {25, {0.05, 0.0022, 0, 9.3, 200}},
    {50, {0.03, 0.0012, 0, 10.3, 200}},
    {60, {0.02, 0.0006, 0, 11, 200}},
    {65, {0.018, 0.00035, 0, 11.25, 350}},
    {70, {0.015, 0.0002, 0, 11.5, 600}},
    {75, {0.015, 0.00012, 0, 11.7, 750}},
    {kDetailQuality, {0.014, 0.0001, 0, 12, 750}},
    {kDetailQuality, {0.014, 0.0001, 0.105, 12, 750}},
    {80, {0.0135, 0.0001, 0.095, 12.1, 750}},
    {90, {0.0125, 0.0001, 0.05, 12.7, 750}},
    {100, {0.01, 0.0001, 0.012, 14.4, 750}},
}};
constexpr std::size_t kSmoothRows = 9;  // the number of rows without detail, which come first
constexpr std::size_t kFadeIn = 4;      // the row that detail begins at where it may begin coarse

// The time to start grows with vertices x harmonics^2, the memory with vertices x harmonics.
constexpr double kLeastCap = 200, kVerticesPerHarmonic = 9, kMaxBasisValues = 12e6;

// log2 of the extent in edges of median length on the clips that the table was measured on, and how much of what a mesh
// has more becomes position bits: all of it would keep the positions' part of STED equal, but it is not all.
constexpr double kTypicalDensity = 6.6, kBitsOfDensity = 0.8, kFewestMoreBits = -1, kMostMoreBits = 2;
// The range of EdgeScale::median that the table is scaled by.
constexpr double kShortestEdge = 0.004, kLongestEdge = 0.05;

OperatingPoint Between(const Row& low, const Row& high, double quality) {
  const double t = (quality - low.quality) / (high.quality - low.quality);
  // Steps are interpolated by their logarithms.
  const auto between = [t](double a, double b) { return b == 0 ? 0.0 : a * std::pow(b / a, t); };
  const OperatingPoint &a = low.point, &b = high.point;
  return {between(a.motion_step, b.motion_step), between(a.displacement_step, b.displacement_step),
          between(a.detail_step, b.detail_step), a.position_bits + t * (b.position_bits - a.position_bits),
          between(a.harmonics, b.harmonics)};
}

// The point of `quality` among `rows`, with at most `max_harmonics`, kLeastCap at least.
OperatingPoint Interpolate(std::span<const Row> rows, double quality, double max_harmonics) {
  std::size_t i = 1;
  while (i + 1 < rows.size() && rows[i].quality < quality) ++i;
  OperatingPoint point = Between(rows[i - 1], rows[i], quality);
  point.harmonics = std::min(point.harmonics, std::max(kLeastCap, max_harmonics));
  return point;
}

}  // namespace

double MostHarmonics(std::uint32_t vertices) {
  return std::max(kLeastCap, std::min(vertices / kVerticesPerHarmonic, kMaxBasisValues / vertices));
}

double BitsOfDensity(const Mesh& mesh) {
  const double edge = MedianEdge<float>(mesh.positions, mesh.triangles);
  if (edge == 0) return 0;
  const std::array<double, 3> size = BoundingBox(mesh.positions).size();
  const double density = std::log2(std::max({size[0], size[1], size[2]}) / edge);
  return std::clamp(kBitsOfDensity * (density - kTypicalDensity), kFewestMoreBits, kMostMoreBits);
}

EdgeScale EdgeScaleOf(const Mesh& mesh, double rms) {
  const double edge = MedianEdge<float>(mesh.positions, mesh.triangles);
  if (edge == 0) return {};
  return {std::clamp(edge / rms, kShortestEdge, kLongestEdge), BitsOfDensity(mesh)};
}

OperatingPoint PointOfQuality(double quality, double max_harmonics, const EdgeScale& scale) {
  OperatingPoint point = Interpolate(kTable, quality, max_harmonics);
  point.detail_step *= scale.median;
  point.position_bits += scale.more_bits;
  return point;
}

OperatingPoint SmoothPointOfQuality(double quality, double max_harmonics) {
  return Interpolate(std::span(kTable).first(kSmoothRows), quality, max_harmonics);
}

OperatingPoint DetailPointOfQuality(double quality, double max_harmonics) {
  constexpr double kCoarsest = 1;  // the detail step, in edges, that detail begins with
  std::vector<Row> rows{kTable[kFadeIn]};
  rows[0].point.detail_step = kCoarsest;
  rows.insert(rows.end(), kTable.begin() + kSmoothRows, kTable.end());
  OperatingPoint point = Interpolate(rows, quality, max_harmonics);
  point.detail_step *= EdgeScale{}.median;
  return point;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "metrics/error_meter.h"

#include <cassert>
#include <cmath>

namespace sac {
namespace {

// The larger of two errors; a NaN is larger than all.
double Larger(double a, double b) { return a > b || std::isnan(a) ? a : b; }

// The metrics, but for KG and STED, of the frames of two meshes.
DistortionMetrics Joined(const DistortionMetrics& a, const DistortionMetrics& b) {
  DistortionMetrics m;
  m.frames = a.frames + b.frames;
  if (m.frames == 0) return m;
  const auto mean = [&](double x, double y) {
    return std::sqrt((static_cast<double>(a.frames) * x * x + static_cast<double>(b.frames) * y * y) /
                     static_cast<double>(m.frames));
  };
  m.sted_s = mean(a.sted_s, b.sted_s);
  m.sted_t = mean(a.sted_t, b.sted_t);
  m.max_error = Larger(a.max_error, b.max_error);
  m.seam_gap = Larger(a.seam_gap, b.seam_gap);
  m.worst_part = Larger(a.worst_part.kg, b.worst_part.kg) == a.worst_part.kg && a.worst_part.vertices > 0
                     ? a.worst_part
                     : b.worst_part;
  return m;
}

}  // namespace

ErrorMeter::ErrorMeter(std::vector<Triangle> triangles, std::size_t vertices)
    : spatial_(triangles, vertices), temporal_(vertices), parts_(triangles, vertices) {}

void ErrorMeter::Add(const Positions& original, const Positions& decoded) {
  assert(original.size() == decoded.size());
  kg_.Add(original, decoded);
  spatial_.Add(original, decoded);
  temporal_.Add(original, decoded);
  seam_gap_.Add(original, decoded);
  parts_.Add(original, decoded);
  for (std::size_t v = 0; v < original.size(); ++v) {
    double d2 = 0;
    for (int c = 0; c < 3; ++c) {
      const double d = double{original[v][c]} - decoded[v][c];
      d2 += d * d;
    }
    if (d2 > max_error2_ || std::isnan(d2)) max_error2_ = d2;  // a NaN stays: no comparison with it holds
  }
  ++frames_;
}

DistortionMetrics ErrorMeter::OfThisMesh() const {
  DistortionMetrics m;
  m.sted_s = spatial_.Value();
  m.sted_t = temporal_.Value();
  m.max_error = std::sqrt(max_error2_);
  m.seam_gap = seam_gap_.Value();
  m.worst_part = parts_.Worst();
  m.frames = frames_;
  return m;
}

void ErrorMeter::BeginMesh(std::vector<Triangle> triangles, std::size_t vertices) {
  before_ = Joined(before_, OfThisMesh());
  spatial_ = SpatialSted(triangles, vertices);
  temporal_ = TemporalSted(vertices);
  seam_gap_ = SeamGap();
  parts_ = PartError(triangles, vertices);
  max_error2_ = 0;
  frames_ = 0;
}

DistortionMetrics ErrorMeter::Result() const {
  DistortionMetrics m = before_.frames == 0 ? OfThisMesh() : Joined(before_, OfThisMesh());
  m.kg = kg_.Value();
  m.sted = std::hypot(m.sted_s, kStedWeight * m.sted_t);
  return m;
}

}  // namespace sac

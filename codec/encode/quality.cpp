// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sac {
namespace {

// docs/quality.md has the rates and errors of these rows. Detail begins where finer motion and displacement no longer
// reduce the error.
constexpr std::array<QualitySettings, 11> kTable = {{
    {0, 0.15, 0.008, 0, 7.4, 200},
    {10, 0.08, 0.004, 0, 8.4, 200},
    {25, 0.05, 0.0022, 0, 9.3, 200},
    {50, 0.03, 0.0012, 0, 10.3, 200},
    {60, 0.02, 0.0006, 0, 11, 200},
    {65, 0.018, 0.00035, 0, 11.25, 350},
    {70, 0.015, 0.0002, 0, 11.5, 600},
    {kDetailQuality, 0.015, 0.00012, 0, 11.7, 750},
    {80, 0.02, 0.0005, 0.005, 12, 200},
    {90, 0.02, 0.0005, 0.002, 12.6, 200},
    {100, 0.015, 0.0004, 0.0004, 14.4, 200},
}};

// Between a row without detail and one with it, detail begins at this fraction of the way: before it, the step would be
// so coarse that nothing would be coded.
constexpr double kLeastDetail = 0.02;

// The time to start grows with vertices x harmonics^2, the memory with vertices x harmonics.
constexpr double kLeastCap = 200, kVerticesPerHarmonic = 9, kMostBasisValues = 12e6, kMostHarmonics = 1000;

QualitySettings Between(const QualitySettings& low, const QualitySettings& high, double quality) {
  const double t = (quality - low.quality) / (high.quality - low.quality);
  // Steps are interpolated by their logarithms.
  const auto between = [t](double a, double b) {
    if (a == 0) return b == 0 || t < kLeastDetail ? 0.0 : b / t;  // detail fades in from an infinite step
    return a * std::pow(b / a, t);
  };
  return {quality,
          between(low.motion_step, high.motion_step),
          between(low.displacement_step, high.displacement_step),
          between(low.detail_step, high.detail_step),
          low.position_bits + t * (high.position_bits - low.position_bits),
          between(low.harmonics, high.harmonics)};
}

QualitySettings Interpolate(const std::vector<QualitySettings>& rows, double quality) {
  std::size_t i = 1;
  while (i + 1 < rows.size() && rows[i].quality < quality) ++i;
  return Between(rows[i - 1], rows[i], quality);
}

}  // namespace

HarmonicLimits HarmonicLimitsOf(std::uint32_t vertices) {
  const double n = vertices;
  return {std::max(kLeastCap, n / kVerticesPerHarmonic),
          std::max(kLeastCap, std::min(kMostBasisValues / n, kMostHarmonics))};
}

QualitySettings SettingsOfQuality(double quality, const HarmonicLimits& limits) {
  std::vector<QualitySettings> rows;
  for (const QualitySettings& row : kTable) {
    if (row.harmonics <= std::max(kLeastCap, limits.useful)) rows.push_back(row);
  }
  QualitySettings settings = Interpolate(rows, quality);
  settings.harmonics = std::min(settings.harmonics, std::max(kLeastCap, limits.quick));
  return settings;
}

QualitySettings SmoothSettingsOfQuality(double quality, double most_harmonics) {
  std::vector<QualitySettings> rows;
  for (const QualitySettings& row : kTable) {
    if (row.detail_step == 0) rows.push_back(row);
  }
  QualitySettings settings = Interpolate(rows, quality);
  settings.harmonics = std::min(settings.harmonics, std::max(kLeastCap, most_harmonics));
  return settings;
}

}  // namespace sac

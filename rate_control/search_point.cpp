// SPDX-License-Identifier: Apache-2.0
#include "rate_control/search_point.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "codec/encode/quality.h"
#include "sac/limits.h"

namespace sac {
namespace {

constexpr double kMinBits = 4, kMaxBits = 20;

// Means over the clips of docs/quality.md.
constexpr std::array<TypicalFigures, 11> kTypical = {{{0, 4.8, 0.22, 0.06},
                                                      {10, 2.9, 0.12, 0.085},
                                                      {25, 1.9, 0.075, 0.12},
                                                      {50, 1.35, 0.051, 0.16},
                                                      {60, 1, 0.042, 0.2},
                                                      {70, 0.55, 0.035, 0.29},
                                                      {75, 0.45, 0.033, 0.36},
                                                      {78, 0.4, 0.031, 0.42},
                                                      {80, 0.145, 0.025, 0.75},
                                                      {90, 0.083, 0.0165, 1.26},
                                                      {100, 0.024, 0.0065, 3}}};

}  // namespace

OperatingPoint PointOf(const SearchPoint& point, const CodingMode& mode, std::uint32_t fixed_harmonics,
                       double max_harmonics, double bits_of_density) {
  const double limit = fixed_harmonics > 0 ? fixed_harmonics : max_harmonics;
  const OperatingPoint s =
      mode.detail ? DetailPointOfQuality(point.quality, limit) : SmoothPointOfQuality(point.quality, limit);
  double harmonics = fixed_harmonics;
  if (fixed_harmonics == 0) {
    harmonics = std::round(std::min(s.harmonics * std::exp(point.log_harmonics), limit));
    harmonics = std::clamp(harmonics, 1.0, static_cast<double>(Limits{}.expert.harmonics));
  }
  // Position bits are rounded to three digits, as documents and reports show them.
  return {s.motion_step * std::exp(point.log_motion), s.displacement_step, s.detail_step,
          std::clamp(std::round(1e3 * (s.position_bits + bits_of_density + point.more_bits)) / 1e3, kMinBits, kMaxBits),
          harmonics};
}

EncoderSettings SettingsOf(const OperatingPoint& point, double quality, const EncoderSettings& base) {
  EncoderSettings s = base;
  s.quality = std::clamp(quality, 0.0, 100.0);
  s.harmonics = static_cast<std::uint32_t>(point.harmonics);
  s.motion_step = point.motion_step;
  s.displacement_step = point.displacement_step;
  s.detail_step = point.detail_step;
  s.position_bits = point.position_bits;
  return s;
}

TypicalFigures TypicalOf(double quality) {
  std::size_t i = 1;
  while (i + 1 < kTypical.size() && kTypical[i].quality < quality) ++i;
  const TypicalFigures &a = kTypical[i - 1], &b = kTypical[i];
  const double t = (quality - a.quality) / (b.quality - a.quality);
  const auto between = [t](double from, double to) { return from * std::pow(to / from, t); };
  return {quality, between(a.kg, b.kg), between(a.sted, b.sted), between(a.bpvf, b.bpvf)};
}

double TypicalQuality(double TypicalFigures::*figure, double target) {
  const bool falls = kTypical.front().*figure > kTypical.back().*figure;
  for (std::size_t i = 1; i < kTypical.size(); ++i) {
    const double a = kTypical[i - 1].*figure, b = kTypical[i].*figure;
    if (i + 1 < kTypical.size() && (falls ? b > target : b < target)) continue;
    const double t = std::clamp(std::log(target / a) / std::log(b / a), -3.0, 3.0);
    return kTypical[i - 1].quality + t * (kTypical[i].quality - kTypical[i - 1].quality);
  }
  return 50;
}

}  // namespace sac

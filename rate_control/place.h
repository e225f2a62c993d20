// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "rate_control/trial.h"
#include "sac/encoder.h"

namespace sac {

// A place near the table of qualities: steps, bits and harmonics by `quality`, and how far some are from them.
struct Place {
  double quality = 50;       // beyond 0..100 the table goes on
  double log_motion = 0;     // log of the motion step over that of the table
  double more_bits = 0;      // of positions
  double log_harmonics = 0;  // likewise

  bool operator==(const Place&) const = default;
};

// The two ways of coding that a search tries: the smooth planes alone, or detail over few harmonics.
struct Branch {
  bool detail;
  double least_quality, most_quality;
};
inline constexpr Branch kSmooth{false, -40, 95}, kDetailed{true, 60.6, 125};

// The harmonics are `fixed_harmonics` unless these are 0, and else no more than `most_harmonics`.
OperatingPoint PointOf(const Place& place, const Branch& branch, std::uint32_t fixed_harmonics, double most_harmonics);

// `base` with what the point says. With `fixed_harmonics` they stay as they are in `base`.
EncoderSettings SettingsOf(const OperatingPoint& point, double quality, const EncoderSettings& base);

// Figures that a quality comes to on most clips, to begin with.
struct Typical {
  double quality, kg, sted, bpvf;
};
// The figures of a quality from 0 to 100.
Typical TypicalOf(double quality);
// The quality at which `figure` typically comes to `target`.
double TypicalQuality(double Typical::*figure, double target);

}  // namespace sac

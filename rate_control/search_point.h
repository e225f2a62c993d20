// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "rate_control/trial.h"
#include "sac/encoder.h"

namespace sac {

// A point of the search space. It stands for the steps, bits and harmonics of `quality` in the table of qualities
// (codec/encode/quality.h), some of them changed.
struct SearchPoint {
  double quality = 50;       // the table is continued below 0 and above 100
  double log_motion = 0;     // natural logarithm of the ratio of the motion step to the table's
  double more_bits = 0;      // position bits beyond the table's
  double log_harmonics = 0;  // natural logarithm of the ratio of the number of harmonics to the table's

  bool operator==(const SearchPoint&) const = default;
};

// One of the two ways of coding that a search tries, with the range of qualities tried: motion and displacement alone
// (the smooth planes), or these with few harmonics and a detail plane.
struct CodingMode {
  bool detail;
  double min_quality, max_quality;
};
inline constexpr CodingMode kSmooth{false, -40, 110}, kDetailed{true, 60.6, 125};

// The settings that `point` stands for, with `bits_of_density` position bits more. The number of harmonics is
// `fixed_harmonics` or, when that is 0, at most `max_harmonics`.
OperatingPoint PointOf(const SearchPoint& point, const CodingMode& mode, std::uint32_t fixed_harmonics,
                       double max_harmonics, double bits_of_density);

// `base` with the settings of `point`, and with `quality` limited to 0..100.
EncoderSettings SettingsOf(const OperatingPoint& point, double quality, const EncoderSettings& base);

// The errors and the rate that a quality typically gives: KG in percent, STED, and bits per vertex and frame. A search
// begins with them.
struct TypicalFigures {
  double quality, kg, sted, bpvf;
};
// What a quality from 0 to 100 comes to on most clips.
TypicalFigures TypicalOf(double quality);
// The quality at which the member `figure` typically equals `target`.
double TypicalQuality(double TypicalFigures::*figure, double target);

}  // namespace sac

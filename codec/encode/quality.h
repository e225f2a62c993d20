// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sac {

// The settings that one quality stands for.
struct QualitySettings {
  double quality;
  double motion_step;        // radians and strain
  double displacement_step;  // fraction of the RMS radius
  double detail_step;        // fraction of the RMS radius; 0: no detail plane
  double position_bits;      // log2 of the extent in the I-frame's steps
  double harmonics;
};

// The quality from which streams have a detail plane. Where the number of harmonics is capped, detail begins a little
// earlier.
inline constexpr double kDetailQuality = 75;

// The largest number of harmonics that is worth using for a mesh of `vertices` vertices, at least 200. In a small mesh,
// more harmonics approach a code for every vertex, which the detail plane does better. In a large mesh, decoders would
// take long to start.
double MostHarmonics(std::uint32_t vertices);

// The settings of `quality`, from a table measured on several clips (docs/quality.md). They are interpolated between
// the table's rows that have at most max(most_harmonics, 200) harmonics. The table covers 0 to 100; beyond, it is
// continued with the ratios of its last rows.
QualitySettings SettingsOfQuality(double quality, double most_harmonics);

// The same without a detail plane: beyond kDetailQuality the other steps become finer instead.
QualitySettings SmoothSettingsOfQuality(double quality, double most_harmonics);

}  // namespace sac

#pragma once

namespace sac {

// What one figure of quality stands for.
struct QualitySettings {
  double quality;
  double motion_step;        // radians and strain
  double displacement_step;  // fraction of the RMS radius
  double detail_step;        // fraction of the RMS radius; 0: no detail plane
  double position_bits;      // log2 of the extent in the I-frame's steps
};

// `quality` from 0 to 100: from a table measured on several clips (docs/quality.md), interpolated between its rows.
QualitySettings SettingsOfQuality(double quality);

}  // namespace sac

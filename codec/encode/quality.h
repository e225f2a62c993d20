#pragma once

namespace sac {

// What one figure of quality stands for.
struct QualitySettings {
  double motion_step;        // radians and strain
  double displacement_step;  // fraction of the RMS radius
  int position_bits;
};

// From a table measured on several clips (docs/quality.md), interpolated between its rows.
QualitySettings SettingsOfQuality(double quality);

}  // namespace sac

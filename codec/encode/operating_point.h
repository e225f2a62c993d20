// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sac {

// The settings that trade rate for distortion: what a quality, a bound on the error or a search chooses.
struct OperatingPoint {
  double motion_step = 0;        // radians and strain
  double displacement_step = 0;  // fraction of the first frame's RMS radius
  double detail_step = 0;        // fraction of the RMS radius; 0: no detail plane
  double position_bits = 0;      // log2 of the extent in the I-frame's steps
  double harmonics = 0;
};

}  // namespace sac

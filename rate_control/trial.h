// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "sac/clip.h"
#include "sac/encoder.h"
#include "sac/status.h"
#include "sac/stream_info.h"

namespace sac {

// The settings that a search chooses.
struct OperatingPoint {
  double motion_step = 0;        // radians and strain
  double displacement_step = 0;  // fraction of the RMS radius
  double detail_step = 0;        // fraction of the RMS radius; 0: no detail plane
  double position_bits = 0;
  double harmonics = 0;
};

// The result of an encoding with given settings.
struct Trial {
  EncoderSettings settings;
  OperatingPoint point;     // the origin of the settings, if a search chose them
  std::uint64_t bytes = 0;  // of the whole stream
  StreamBytes parts;        // sum to `bytes`
  double vertices = 0;
  double bpvf = 0;  // bits a vertex and frame, of all bytes
  double kg = 0;    // percent
  double sted = 0;
};

// Encodes a clip with trial.settings, decodes the stream again as it comes, and measures it against the clip. The other
// members of `trial` but its point are set.
Status RunTrial(ClipReader& clip, Trial& trial);

}  // namespace sac

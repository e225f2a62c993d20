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
  double position_bits = 0;      // log2 of the extent in the I-frame's steps
  double harmonics = 0;
};

// An encoding with given settings, and its result.
struct Trial {
  EncoderSettings settings;
  OperatingPoint point;     // the settings that a search chose, if one did
  std::uint64_t bytes = 0;  // size of the whole stream
  StreamBytes parts;        // sizes of the parts of the stream, which sum to `bytes`
  double vertices = 0;
  double bpvf = 0;  // bits per vertex and frame, all bytes counted
  double kg = 0;    // percent
  double sted = 0;
};

// Encodes a clip with trial.settings, decodes the stream while it is encoded, and measures the decoded frames against
// the clip. Sets all members of `trial` but `settings` and `point`.
Status RunTrial(ClipReader& clip, Trial& trial);

}  // namespace sac

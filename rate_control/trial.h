// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "codec/encode/operating_point.h"
#include "sac/clip.h"
#include "sac/clip_encoder.h"
#include "sac/encoder.h"
#include "sac/status.h"
#include "sac/stream_info.h"

namespace sac {

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

  // Sets all members but `settings` and `point`.
  void Take(const EncodedClip& encoded);
};

// Encodes a clip from its first frame with trial.settings, decodes the stream while it is encoded, and measures the
// decoded frames against the clip. Sets all members of `trial` but `settings` and `point`.
Status RunTrial(ClipReader& clip, Trial& trial);

}  // namespace sac

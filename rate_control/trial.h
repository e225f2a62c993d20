#pragma once

#include <cstdint>
#include <functional>

#include "sac/encoder.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// A clip that can be read again and again.
struct ClipSource {
  const Mesh* mesh = nullptr;                               // the first frame
  std::function<void()> rewind;                             // begins again with the first frame
  std::function<Status(Positions& frame, bool& end)> next;  // `end` is set, and `frame` left alone, after the last
};

// What of the settings a search chooses.
struct OperatingPoint {
  double motion_step = 0;        // radians and strain
  double displacement_step = 0;  // fraction of the RMS radius
  double detail_step = 0;        // fraction of the RMS radius; 0: no detail plane
  double position_bits = 0;
  double harmonics = 0;
};

// What an encoding with some settings came to.
struct Trial {
  EncoderSettings settings;
  OperatingPoint point;     // where the settings are from, if a search chose them
  std::uint64_t bytes = 0;  // of the whole stream
  StreamBytes parts;        // that add up to them
  double vertices = 0;
  double bpvf = 0;  // bits a vertex and frame, of all bytes
  double kg = 0;    // percent
  double sted = 0;
};

// Encodes a clip, decodes it again as it comes, and measures what comes out against the input (`settings` in, the rest
// out). Memory holds the frames of a group. `frame_done` is told how many frames are decoded.
Status RunTrial(const ClipSource& clip, const std::function<void(std::uint32_t)>& frame_done, Trial& trial);

}  // namespace sac

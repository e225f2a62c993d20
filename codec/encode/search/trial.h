#pragma once

#include <cstdint>
#include <functional>

#include "codec/encode/encoder.h"
#include "codec/mesh.h"
#include "format/status.h"

namespace sac {

// A clip that can be read again and again.
struct ClipSource {
  const Mesh* mesh = nullptr;                               // the first frame
  std::function<void()> rewind;                             // begins again with the first frame
  std::function<Status(Positions& frame, bool& end)> next;  // `end` is set, and `frame` left alone, after the last
};

// What an encoding with some settings came to.
struct Trial {
  EncoderSettings settings;
  std::uint64_t bytes = 0;  // of the whole stream
  double bpvf = 0;          // bits a vertex and frame, of all bytes
  double kg = 0;            // percent
  double sted = 0;
};

// Encodes a clip, decodes it again as it comes, and measures what comes out against the input (`settings` in, the rest
// out). Memory holds the frames of a group. `frame_done` is told how many frames are decoded.
Status RunTrial(const ClipSource& clip, const std::function<void(std::uint32_t)>& frame_done, Trial& trial);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rate_control/shape_residual.h"
#include "sac/clip.h"
#include "sac/clip_encoder.h"
#include "sac/encoder.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Takes the next bytes of a stream. A status that is not ok ends the encoding.
using ByteSink = std::function<Status(std::span<const std::uint8_t> bytes)>;

// Returns `status` with `name`, such as a clip's, put before its message. Returns it unchanged when it is ok or `name`
// is empty.
Status Named(const std::string& name, const Status& status);

// What an encoding does beside coding the frames of a clip.
struct EncodingTask {
  // The mesh of each segment's I-frame; the clip's own where there is none.
  std::span<const std::optional<Mesh>> shapes = {};
  std::span<const LookAhead> known = {};  // of each segment
  bool measure = true;                    // decodes the stream while it is encoded and measures it against the clip
  ByteSink sink;                          // gets the bytes; it may be empty
  // With `measure`: gets the decoded shape and all frames of a clip that has one segment; null: nobody does.
  ShapeResidual* residual = nullptr;
  const ClipPart* part = nullptr;  // null: the clip begins with its first frame and has a start of its own
};

// Encodes a clip from its first frame on, each of its meshes as a segment. All members of `result` but the numbers of
// trials and of rounds are set. Error messages begin with the clip's name and, where a frame is at fault, its number.
Status EncodeAndMeasure(ClipReader& clip, const EncoderSettings& settings, const EncodingTask& task,
                        EncodedClip& result);

}  // namespace sac

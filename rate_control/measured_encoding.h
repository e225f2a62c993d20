// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "sac/clip.h"
#include "sac/clip_encoder.h"
#include "sac/encoder.h"
#include "sac/status.h"

namespace sac {

// Takes the next bytes of a stream. A status that is not ok ends the encoding.
using ByteSink = std::function<Status(std::span<const std::uint8_t> bytes)>;

// Returns `status` with `name`, such as a clip's, put before its message. Returns it unchanged when it is ok or `name`
// is empty.
Status Named(const std::string& name, const Status& status);

// Encodes a clip from its first frame on. With `measure` it decodes the stream while it is encoded and measures the
// decoded frames against the clip. `sink` gets the bytes; it may be empty. All members of `result` but the number of
// trials are set. Error messages begin with the clip's name and, where a frame is at fault, its number.
Status EncodeAndMeasure(ClipReader& clip, const EncoderSettings& settings, bool measure, const ByteSink& sink,
                        EncodedClip& result);

}  // namespace sac

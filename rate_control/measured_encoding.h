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

// Takes the bytes of a stream in order. A status that is not ok ends the encoding.
using ByteSink = std::function<Status(std::span<const std::uint8_t> bytes)>;

// `status` with its message after `name`, such as a clip's; the same when it is ok or there is no name.
Status Named(const std::string& name, const Status& status);

// Encodes a clip from its first frame on and, with `measure`, decodes the stream as it comes and measures it against
// the clip. `sink` may be empty. `result` gets everything but the number of trials. Messages about the clip begin with
// its name.
Status EncodeAndMeasure(ClipReader& clip, const EncoderSettings& settings, bool measure, const ByteSink& sink,
                        EncodedClip& result);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "rate_control/held_stream.h"
#include "rate_control/measured_encoding.h"
#include "sac/clip.h"
#include "sac/clip_encoder.h"
#include "sac/encoder.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// The shape that was chosen for the I-frame of a clip, and the encoding of the whole clip from it.
struct ChosenShape {
  std::optional<Mesh> mesh;  // empty: the clip's first frame
  EncodedClip encoded;       // without the number of trials
  HeldStream stream;
};

// How many rounds another shape than the first frame is sought in. None with a bound on the error, where frames have to
// be coded as they come, and where they do not all refer to one shape.
std::uint32_t RoundsOf(const ClipEncoding& encoding);

// Encodes a clip of one segment from its first frame and then, `rounds` times, from the shape that the encoding before
// says is nearer to all frames (ShapeResidual). The first and the last encoding are of all frames; those between are of
// every third frame, since they only have to say where the shape is wrong. Of the two whole encodings that one is
// chosen which costs less: bytes * KG^0.6 * STED^0.4.
//
// `known` is of the clip's frames.
//
// `settings_of_next` returns the settings of the next encoding, which are always the same but for the progress
// callback. An encoding that fails from a fitted shape ends the search for one. The result is the status of the
// encoding that is chosen, with the errors of EncodeAndMeasure(); chosen.stream holds the frames before the one at
// fault then.
Status ChooseShape(ClipReader& clip, const LookAhead& known, std::uint32_t rounds,
                   const std::function<EncoderSettings()>& settings_of_next, ChosenShape& chosen);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "sac/clip.h"
#include "sac/distortion.h"
#include "sac/encoder.h"
#include "sac/status.h"
#include "sac/stream_info.h"

namespace sac {

// Bounds that the stream of a whole clip keeps. A bound is met within 3 % where the clip lets it.
//
// With kg, sted or both the result is the smallest stream found that keeps them; with bpvf alone the best quality
// within the size; with bpvf beside the others the smallest stream that keeps those, if it is within the size.
struct RateTargets {
  std::optional<double> kg;    // percent
  std::optional<double> sted;  // no unit
  std::optional<double> bpvf;  // bits a vertex and frame, all bytes counted

  bool any() const { return kg || sted || bpvf; }
};

// How far an encoding is. Settings for targets and the shape of the I-frame are found by trial encodings.
struct EncodingProgress {
  // Number of the trial encoding, from 1; 0: an encoding that is no trial. The bytes that are given out may be those of
  // a trial, and then there is no other encoding.
  std::uint32_t trial = 0;
  std::uint32_t frames = 0;  // that are coded in it
};

// Rounds of fitting the I-frame's shape that pay for their time on most clips (docs/decisions.md).
inline constexpr std::uint32_t kReferenceRounds = 2;

// A part of a clip that is encoded from the start of the whole.
struct ClipPart {
  std::vector<std::uint8_t> start;  // Encoder::start()
  std::uint32_t first_frame = 0;    // the number in the clip of the first frame that the reader gives
};

struct ClipEncoding {
  EncoderSettings encoder;  // steps, position bits, quality and, unless given, harmonics are searched with targets
  RateTargets targets;
  bool measure = true;  // false: the stream is neither decoded nor measured unless there are targets
  // Rounds of fitting the I-frame's shape, which frames are measured from, to all frames. It is taken where the whole
  // clip costs less with it. 0: the shape is the first frame. It is also the first frame with a bound on the error,
  // with low_delay, where the reference is the frame before, and in clips of three frames or fewer. Where it is not
  // given: kReferenceRounds, or 0 if `measure` is false and there are no targets.
  std::optional<std::uint32_t> reference_rounds;
  // With it the reader gives a run of frames of one segment, beginning at a border of groups, which is encoded from the
  // start: see Encoder::CreateFrom(). The metadata say the number of its first frame. No targets; the shape is the
  // start's.
  std::optional<ClipPart> part;
  // Is called between frames, on the caller's thread. Returns whether to go on; false ends in kCancelled.
  std::function<bool(const EncodingProgress&)> progress;
};

// What an encoding came to.
struct EncodedClip {
  EncoderSettings settings;  // with what a search has chosen
  StreamInfo info;           // of the last segment
  StreamBytes parts;
  std::vector<std::uint32_t> order;  // per decoded vertex its index in the input; of the last segment
  std::uint64_t bytes = 0;           // of the whole stream
  std::uint32_t frames = 0;          // in the stream
  std::uint64_t positions = 0;       // vertices of all frames
  std::uint32_t segments = 0;        // meshes
  std::uint32_t group_frames = 0;    // of a full group
  std::uint32_t trials = 0;          // trial encodings: for targets, and for the I-frames' shapes
  bool fitted_reference = false;     // an I-frame's shape is one that was fitted to the frames, not a first frame
  DistortionMetrics distortion;      // of what a decoder makes of the stream; all zero where it was not measured
  // True if the input's texture coordinates could not be coded; known where the stream was decoded.
  bool lost_texture_coordinates = false;
  // The same of normals: those of corners cannot be coded where Draco cannot code the mesh.
  bool lost_normals = false;

  // Bits a vertex and frame, all bytes counted.
  double bpvf() const { return 8 * static_cast<double>(bytes) / static_cast<double>(positions); }
};

// What is known of the frames of a segment before they are coded, as Encoder::Create() takes it; empty
// where there is nothing to know.
struct LookAhead {
  std::vector<std::uint32_t> lowest;  // of each vertex the lowest that it coincides with in all of them
  std::vector<float> reach;           // of each vertex, as EncoderSettings::reach
};

// Reads a clip's first segment as far as there is something to know of its frames: where vertices of its mesh coincide,
// and where parts are much smaller than the whole. Frames that cannot be read or coded end it. The errors of Rewind().
Status ReadAhead(ClipReader& clip, const EncoderSettings& settings, LookAhead& known);

// Encodes a clip, each of its meshes as a segment, decodes the stream again as it comes and measures it against the
// clip, which has to be at its first segment and is rewound before each encoding. Without a frame rate in the settings
// the clip's is taken. `sink` gets the bytes of the stream in order; an error of its own ends the encoding.
// Memory holds the frames of a group, whatever the length of the clip, and streams of up to 64 MB until it is known
// which one is given out.
//
// kInvalidArgument for settings, a mesh or frames that cannot be coded, and, saying what was reached, for targets that
// cannot be met; kLimit where decoders would refuse the stream; kCancelled; the errors of `clip` and `sink`. When a
// frame cannot be coded, `sink` has got a whole stream of the result.frames frames before it, if that is not 0, and
// result.order is set.
Status EncodeClip(ClipReader& clip, const ClipEncoding& encoding,
                  const std::function<Status(std::span<const std::uint8_t> bytes)>& sink, EncodedClip& result);

}  // namespace sac

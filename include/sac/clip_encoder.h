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

// How far an encoding is. A search for settings encodes the clip several times before.
struct EncodingProgress {
  std::uint32_t trial = 0;   // number of the trial encoding, from 1; 0: the encoding whose bytes are given out
  std::uint32_t frames = 0;  // that are coded in it
};

struct ClipEncoding {
  EncoderSettings encoder;  // steps, position bits, quality and, unless given, harmonics are searched with targets
  RateTargets targets;
  bool measure = true;  // false: the stream is neither decoded nor measured unless there are targets
  // Is called between frames, on the caller's thread. Returns whether to go on; false ends in kCancelled.
  std::function<bool(const EncodingProgress&)> progress;
};

// What an encoding came to.
struct EncodedClip {
  EncoderSettings settings;  // with what a search has chosen
  StreamInfo info;
  StreamBytes parts;
  std::vector<std::uint32_t> order;  // per decoded vertex its index in the input
  std::uint64_t bytes = 0;           // of the whole stream
  std::uint32_t frames = 0;          // in the stream
  std::uint32_t trials = 0;          // encodings that a search has made
  DistortionMetrics distortion;      // of what a decoder makes of the stream; all zero where it was not measured
  // True if the input's texture coordinates could not be coded; known where the stream was decoded.
  bool lost_texture_coordinates = false;
  // The same of normals: those of corners cannot be coded where Draco cannot code the mesh.
  bool lost_normals = false;

  // Bits a vertex and frame, all bytes counted.
  double bpvf() const {
    return 8 * static_cast<double>(bytes) / (static_cast<double>(info.vertices) * static_cast<double>(frames));
  }
};

// Encodes a clip, decodes the stream again as it comes and measures it against the clip. Without a frame rate in the
// settings the clip's is taken. `sink` gets the bytes of the stream in order; an error of its own ends the encoding.
// Memory holds the frames of a group, whatever the length of the clip.
//
// kInvalidArgument for settings, a mesh or frames that cannot be coded, and, saying what was reached, for targets that
// cannot be met; kLimit where decoders would refuse the stream; kCancelled; the errors of `clip` and `sink`. When a
// frame cannot be coded, `sink` has got a whole stream of the result.frames frames before it, if that is not 0, and
// result.order is set.
Status EncodeClip(ClipReader& clip, const ClipEncoding& encoding,
                  const std::function<Status(std::span<const std::uint8_t> bytes)>& sink, EncodedClip& result);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/shape.h"
#include "format/sequence_header.h"
#include "sac/encoder.h"
#include "sac/limits.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// The settings that closed groups are made by, as in EncoderSettings.
struct GroupStructureSettings {
  std::uint32_t group = 128;
  std::uint32_t pyramid = 16;
  std::uint32_t base_levels = 0;

  bool operator==(const GroupStructureSettings&) const = default;
};

// The start of a stream as an encoder holds it: header and I-frame, with everything that groups of frames are coded
// from. It is a value that can be written and read, so that several machines can encode groups of the same stream.
struct EncodedStart {
  SequenceHeader header;
  std::vector<std::uint8_t> i_frame;  // payload of the I-frame packet
  std::vector<std::uint32_t> order;   // for each vertex that decoders give out its index in the input
  double max_error = 0;               // bound on the error of any vertex, model units; 0: no bound
  GroupStructureSettings groups;
  Shape shape;
};

// Codes the I-frame and computes its harmonics. The positions of `mesh` are the shape that all frames are measured
// from, which the first frame is or is near to. When decoders would refuse the number of harmonics that a quality
// stands for, fewer are tried. settings.progress is called with 0 between the steps. `lowest` has for each vertex the
// lowest that it is joined with; where it is empty, settings.join says whether those that coincide in `mesh` are.
// `reach` has what settings.reach stands for elsewhere, for each vertex.
//
// Returns kInvalidArgument for settings out of range and for a mesh that cannot be coded, kLimit when decoders with
// settings.limits would refuse the stream or when memory is short, and kCancelled.
Status EncodeStart(const Mesh& mesh, const EncoderSettings& settings, EncodedStart& start,
                   std::span<const std::uint32_t> lowest = {}, std::span<const float> reach = {});

// Returns `start` as bytes: first the bytes that the stream begins with (magic, header packet, I-frame packet), then
// the members that decoders do not need: the error bound as a little-endian f64, the order as one u32 per index, the
// settings of groups as one u32 each, and the CRC-32 of these.
std::vector<std::uint8_t> WriteStreamStart(const EncodedStart& start);

// Reads what WriteStreamStart() wrote and derives the shape as a decoder does. On a machine with the same
// floating-point results, groups encoded from it have the same bytes as groups encoded from the original. On other
// machines the bytes may differ, but the groups decode as well.
//
// Returns kCorrupt when `bytes` are not exactly one start, kLimit when `limits` are exceeded, and
// kUnsupported when the stream has another version or the harmonics computed here are not those of the I-frame. May
// throw std::bad_alloc.
Status ReadStreamStart(std::span<const std::uint8_t> bytes, const Limits& limits, EncodedStart& start);

// How many frames a full closed group has: what the settings say, or as many as decoders with `limits` would take.
std::uint32_t FullGroup(const EncodedStart& start, const Limits& limits);

}  // namespace sac

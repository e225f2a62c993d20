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

// The start of a stream as an encoder holds it: header and I-frame, with all that groups of frames are coded from. It
// is a value: another machine can read it and encode groups of the same stream.
struct EncodedStart {
  SequenceHeader header;
  std::vector<std::uint8_t> i_frame;  // payload of the I-frame packet
  std::vector<std::uint32_t> order;   // per decoded vertex its index in the input
  double max_error = 0;               // bound on the error of any vertex, model units; 0: no bound
  Shape shape;
};

// Codes the first frame and computes its harmonics. A quality gets fewer harmonics than it stands for while decoders
// would refuse the stream. settings.progress is called between the steps, with 0.
//
// Returns kInvalidArgument for settings out of range and for a mesh that cannot be coded, kLimit when decoders with
// settings.limits would refuse the stream or when memory is short, and kCancelled.
Status EncodeStart(const Mesh& first, const EncoderSettings& settings, EncodedStart& start);

// Returns the bytes of `start`: magic, header packet and I-frame packet as a stream begins with them, then what
// decoders need not know: the bound as a little-endian f64, the order as u32 each, and the CRC-32 of these.
std::vector<std::uint8_t> WriteStreamStart(const EncodedStart& start);

// Reads what WriteStreamStart() writes and derives the shape as a decoder does. Groups encoded from the result are the
// same bytes as from the original where floating point is the same; elsewhere they decode as well.
//
// Returns kCorrupt when `bytes` are not all of a start and nothing else, kLimit when `limits` are exceeded, and
// kUnsupported when the stream has another version or the harmonics computed here are not those of the I-frame. May
// throw std::bad_alloc.
Status ReadStreamStart(std::span<const std::uint8_t> bytes, const Limits& limits, EncodedStart& start);

}  // namespace sac

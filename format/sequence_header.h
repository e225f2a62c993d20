// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "format/bytes.h"
#include "sac/limits.h"
#include "sac/status.h"
#include "sac/stream_info.h"
#include "sac/version.h"

namespace sac {

inline constexpr std::uint8_t kVersionMajor = SAC_STREAM_VERSION_MAJOR;
inline constexpr std::uint8_t kVersionMinor = SAC_STREAM_VERSION_MINOR;

// The sequence header in the order of the bitstream (spec.md 4). Steps are finite and positive; the steps of planes
// that a stream may leave out may be zero.
struct SequenceHeader {
  std::uint8_t version_major = kVersionMajor;
  std::uint8_t version_minor = kVersionMinor;
  std::uint8_t reference_shape = 0;  // ReferenceShape
  std::uint8_t position_bits = 10;   // of the position grid, 1..24
  std::uint8_t level_growth = 64;    // of the planes' steps from level to level of a pyramid, in 1/64: 64..128
  std::uint32_t vertices = 0;
  std::uint32_t copies = 0;  // what decoders give out beside one of each vertex (spec.md 5.6)
  std::uint32_t triangles = 0;
  std::uint32_t harmonics = 0;             // over all components
  std::uint32_t patch_size = 200;          // vertices of a patch at most, 1..1024
  std::uint32_t frame_rate_numerator = 0;  // 0: unknown
  std::uint32_t frame_rate_denominator = 1;
  float origin_x = 0;  // of the position grid, model units
  float origin_y = 0;
  float origin_z = 0;
  float cell = 1;               // of the position grid, model units
  float motion_step = 0;        // radians (rotation), strain (stretch)
  float displacement_step = 0;  // model units
  float detail_step = 0;        // model units; 0: no detail plane
  float correction_step = 0;    // model units; 0: no correction plane
  float rotation_step = 0;      // of the rigid motion, radians
  float translation_step = 0;   // of the rigid motion, model units
  // Where the origin of the positions is in the author's coordinates, model units; only in the bytes if it is not zero.
  double offset_x = 0;
  double offset_y = 0;
  double offset_z = 0;

  // The vertices that decoders give out.
  std::uint64_t given_out() const { return std::uint64_t{vertices} + copies; }
  bool has_offset() const { return offset_x != 0 || offset_y != 0 || offset_z != 0; }
  bool references_previous() const { return reference_shape == static_cast<std::uint8_t>(ReferenceShape::kPrevious); }
  double frames_per_second() const {
    return static_cast<double>(frame_rate_numerator) / static_cast<double>(frame_rate_denominator);
  }
};

// Calls `visit(name, field)` for each field in the order of the bitstream. Reading, writing and printing all use this
// list.
template <class Header, class Visitor>
void VisitFields(Header& h, Visitor&& visit) {
  visit("version_major", h.version_major);
  visit("version_minor", h.version_minor);
  visit("reference_shape", h.reference_shape);
  visit("position_bits", h.position_bits);
  visit("level_growth", h.level_growth);
  visit("vertices", h.vertices);
  visit("copies", h.copies);
  visit("triangles", h.triangles);
  visit("harmonics", h.harmonics);
  visit("patch_size", h.patch_size);
  visit("frame_rate_numerator", h.frame_rate_numerator);
  visit("frame_rate_denominator", h.frame_rate_denominator);
  visit("origin_x", h.origin_x);
  visit("origin_y", h.origin_y);
  visit("origin_z", h.origin_z);
  visit("cell", h.cell);
  visit("motion_step", h.motion_step);
  visit("displacement_step", h.displacement_step);
  visit("detail_step", h.detail_step);
  visit("correction_step", h.correction_step);
  visit("rotation_step", h.rotation_step);
  visit("translation_step", h.translation_step);
}

// The same for the fields that follow these where there is an offset.
template <class Header, class Visitor>
void VisitOffset(Header& h, Visitor&& visit) {
  visit("offset_x", h.offset_x);
  visit("offset_y", h.offset_y);
  visit("offset_z", h.offset_z);
}

// Returns the payload of a header packet: u8 fields as one byte, u32 fields as varints, floats as four bytes,
// doubles as eight.
std::vector<std::uint8_t> WriteSequenceHeader(const SequenceHeader& header);

// Parses and checks every field. Returns kUnsupported for another version, kCorrupt when a rule of spec.md 4 is broken,
// and kLimit when `limits` are exceeded.
Status ParseSequenceHeader(std::span<const std::uint8_t> payload, const Limits& limits, SequenceHeader& header);

// The part of the header that callers of the libraries get.
StreamInfo InfoOf(const SequenceHeader& header);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "format/sequence_header.h"

#include <cmath>
#include <string>

#include "format/memory.h"

namespace sac {
namespace {

struct FieldWriter {
  ByteWriter out;
  void operator()(const char*, const std::uint8_t& v) { out.U8(v); }
  void operator()(const char*, const std::uint32_t& v) { out.Varint(v); }
  void operator()(const char*, const float& v) { out.F32(v); }
  void operator()(const char*, const double& v) { out.F64(v); }
};

struct FieldReader {
  ByteReader in;
  void operator()(const char*, std::uint8_t& v) { v = in.U8(); }
  void operator()(const char*, std::uint32_t& v) { v = in.Varint(); }
  void operator()(const char*, float& v) { v = in.F32(); }
  void operator()(const char*, double& v) { v = in.F64(); }
};

Status Exceeds(const char* what, std::uint64_t value, std::uint64_t limit) {
  return Status::Limit(std::to_string(value) + " " + what + ", the limit is " + std::to_string(limit));
}

}  // namespace

std::vector<std::uint8_t> WriteSequenceHeader(const SequenceHeader& header) {
  FieldWriter writer;
  VisitFields(header, writer);
  if (header.has_offset()) VisitOffset(header, writer);
  return std::move(writer.out.bytes());
}

Status ParseSequenceHeader(std::span<const std::uint8_t> payload, const Limits& limits, SequenceHeader& header) {
  // The version decides what the rest means, so it is judged before the length.
  if (payload.size() >= 2 && (payload[0] != kVersionMajor || payload[1] != kVersionMinor)) {
    return Status::Unsupported("format version " + std::to_string(payload[0]) + "." + std::to_string(payload[1]) +
                               ", this decoder reads " + std::to_string(kVersionMajor) + "." +
                               std::to_string(kVersionMinor));
  }
  FieldReader reader{ByteReader(payload)};
  VisitFields(header, reader);
  const bool has_offset = reader.in.remaining() > 0;
  if (has_offset) VisitOffset(header, reader);
  if (!reader.in.ok() || reader.in.remaining() != 0) return Status::Corrupt("sequence header: wrong length");
  if (header.reference_shape > 1) return Status::Corrupt("sequence header: unknown reference shape");
  if (header.position_bits < 1 || header.position_bits > 24) return Status::Corrupt("sequence header: position bits");
  if (header.level_growth < 64 || header.level_growth > 128) return Status::Corrupt("sequence header: level growth");
  if (header.vertices == 0) return Status::Corrupt("sequence header: no vertices");
  if (header.copies > 3 * std::uint64_t{header.triangles}) {
    return Status::Corrupt("sequence header: more copies of vertices than corners");
  }
  if (header.harmonics == 0) return Status::Corrupt("sequence header: no harmonics");
  if (header.harmonics > header.vertices) return Status::Corrupt("sequence header: more harmonics than vertices");
  if (header.patch_size < 1 || header.patch_size > 1024) return Status::Corrupt("sequence header: patch size");
  if (header.frame_rate_denominator == 0) return Status::Corrupt("sequence header: frame rate");
  for (const float v : {header.origin_x, header.origin_y, header.origin_z}) {
    if (!std::isfinite(v)) return Status::Corrupt("sequence header: origin is not finite");
  }
  for (const float v :
       {header.cell, header.motion_step, header.displacement_step, header.rotation_step, header.translation_step}) {
    if (!std::isfinite(v) || v <= 0) return Status::Corrupt("sequence header: a step is not positive");
  }
  for (const float v : {header.detail_step, header.correction_step}) {
    if (!std::isfinite(v) || v < 0) return Status::Corrupt("sequence header: a step is negative");
  }
  for (const double v : {header.offset_x, header.offset_y, header.offset_z}) {
    if (!std::isfinite(v)) return Status::Corrupt("sequence header: the offset is not finite");
  }
  if (has_offset && !header.has_offset()) return Status::Corrupt("sequence header: an offset of zero");
  if (header.given_out() > limits.vertices) return Exceeds("vertices", header.given_out(), limits.vertices);
  if (header.triangles > limits.expert.triangles)
    return Exceeds("triangles", header.triangles, limits.expert.triangles);
  if (MeshMemory(header.vertices, header.copies, header.triangles) > limits.memory)
    return Status::Limit("the mesh takes more memory than the limit");
  return Status::Ok();
}

StreamInfo InfoOf(const SequenceHeader& header) {
  StreamInfo info;
  info.vertices = static_cast<std::uint32_t>(header.given_out());
  info.triangles = header.triangles;
  info.harmonics = header.harmonics;
  info.frame_rate_numerator = header.frame_rate_numerator;
  info.frame_rate_denominator = header.frame_rate_denominator;
  info.reference_shape = static_cast<ReferenceShape>(header.reference_shape);
  info.position_step = static_cast<double>(header.cell);
  info.motion_step = static_cast<double>(header.motion_step);
  info.rotation_step = static_cast<double>(header.rotation_step);
  info.displacement_step = static_cast<double>(header.displacement_step);
  info.detail_step = static_cast<double>(header.detail_step);
  info.correction_step = static_cast<double>(header.correction_step);
  info.offset = {header.offset_x, header.offset_y, header.offset_z};
  return info;
}

}  // namespace sac

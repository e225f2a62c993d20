// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/stream_start.h"

#include <algorithm>
#include <string>
#include <utility>

#include "codec/draco_mesh.h"
#include "codec/harmonics.h"
#include "codec/i_frame.h"
#include "codec/reconstruct.h"
#include "format/crc32.h"
#include "format/range_coder.h"

namespace sac {
namespace {

// Whether frames of both can follow each other in one clip.
bool SameClip(const SequenceHeader& a, const SequenceHeader& b) {
  return a.frame_rate_numerator == b.frame_rate_numerator && a.frame_rate_denominator == b.frame_rate_denominator &&
         a.offset_x == b.offset_x && a.offset_y == b.offset_y && a.offset_z == b.offset_z;
}

}  // namespace

Status StreamStart::CheckOrder(PacketType type) {
  const bool follows_header = std::exchange(follows_header_, false), is_i_frame = type == PacketType::kIFrame;
  is_orphan_ = is_i_frame && !follows_header;
  if (!header_ && type != PacketType::kHeader) {
    return damage_.Judge(Status::Corrupt("a packet before the sequence header"));
  }
  if (!header_ || follows_header == is_i_frame) return Status::Ok();
  return damage_.Judge(
      Status::Corrupt(is_i_frame ? "an I-frame without its sequence header" : "a sequence header without an I-frame"));
}

Status StreamStart::TakeHeader(std::span<const std::uint8_t> payload) {
  last_header_bytes_.clear();
  SequenceHeader parsed;
  Status status = ParseSequenceHeader(payload, limits_, parsed);
  if (status.ok() && mesh_ && !SameClip(parsed, *header_)) {
    status = Status::Corrupt("a sequence header with another frame rate or offset than the first");
  }
  if (!status.ok()) return mesh_ ? damage_.Judge(std::move(status)) : status;
  if (!mesh_) {
    header_ = parsed;
    info_ = InfoOf(parsed);
  }
  last_header_ = parsed;
  last_header_bytes_.assign(payload.begin(), payload.end());
  follows_header_ = true;
  return Status::Ok();
}

Status StreamStart::TakeIFrame(std::span<const std::uint8_t> payload, bool opens_stream) {
  if (is_orphan_) return Status::Ok();
  Bytes bytes{std::exchange(last_header_bytes_, {}), payload.size(), Crc32(payload)};
  if (!mesh_) {
    SAC_RETURN_IF_ERROR(DecodeMesh(last_header_, payload));
    bytes_ = std::move(bytes);
    if (opens_stream) segment_ = 0;
    return Status::Ok();
  }
  if (bytes == bytes_) {
    next_.reset();
    if (!counts_) segment_.reset();  // a later segment may have the same mesh
  } else if (!next_ || next_->bytes != bytes) {
    next_.emplace(Next{std::move(bytes), last_header_, {payload.begin(), payload.end()}, std::nullopt});
  }
  return Status::Ok();
}

Status StreamStart::CheckSegment(std::uint32_t number) {
  const auto wrong = [&] {
    counts_ = false;
    return Status::Corrupt("a group of segment " + std::to_string(number) + " out of place");
  };
  if (next_) {
    // A start that no group follows does not count.
    const bool follows = !segment_ || (counts_ && !damage_.skips() ? number == *segment_ + (is_used_ ? 1 : 0)
                                       : counts_ && is_used_       ? number > *segment_
                                       : counts_                   ? number >= *segment_
                                                                   : number != *segment_);
    if (!follows) return wrong();
    next_->segment = number;
    return Status::Ok();
  }
  if (segment_ && number != *segment_) return wrong();
  segment_ = number;
  counts_ = is_used_ = true;
  return Status::Ok();
}

Status StreamStart::Prepare() {
  if (!mesh_) return Status::NeedMoreData();
  if (next_) return Replace();
  if (is_ready_) return Status::Ok();
  if (failure_.ok()) failure_ = ComputeBasis();
  is_ready_ = failure_.ok();
  return failure_;
}

Status StreamStart::Replace() {
  const Next next = std::move(*next_);
  next_.reset();
  counts_ = false;
  SAC_RETURN_IF_ERROR(DecodeMesh(next.header, next.i_frame));
  bytes_ = next.bytes;
  header_ = next.header;
  info_ = InfoOf(next.header);
  segment_ = next.segment;
  is_ready_ = false;
  failure_ = ComputeBasis();
  is_ready_ = counts_ = failure_.ok();
  is_used_ = true;
  return failure_;
}

void StreamStart::Restart() {
  follows_header_ = counts_ = false;
  next_.reset();
}

Status StreamStart::DecodeMesh(const SequenceHeader& header, std::span<const std::uint8_t> payload) {
  IFrameSyntax syntax;
  RangeDecoder positions({});
  SAC_RETURN_IF_ERROR(ParseIFrame(payload, header, syntax, positions));
  DracoMesh draco;
  SAC_RETURN_IF_ERROR(DecodeDraco(syntax.mesh, header, draco));
  DecodedIFrame decoded;
  SAC_RETURN_IF_ERROR(AssembleIFrame(syntax, header, std::move(draco), positions, decoded));
  Mesh out;
  out.triangles = decoded.copy_triangles.empty() ? decoded.mesh.triangles : std::move(decoded.copy_triangles);
  out.uvs = std::move(decoded.uvs);
  out.uv_triangles = std::move(decoded.uv_triangles);
  out.normals = std::move(decoded.normals);
  out.normal_triangles = std::move(decoded.normal_triangles);
  out.colors = std::move(decoded.colors);
  ToPositions(ShapePositions(header, decoded.mesh), out.positions);
  SpreadToCopies(decoded.mesh.vertex_of_copy, out.positions);
  mesh_ = std::move(out);
  order_ = std::exchange(syntax.order, {});
  syntax_ = std::move(syntax);
  decoded_ = std::move(decoded.mesh);
  return Status::Ok();
}

Status StreamStart::ComputeBasis() {
  shape_ = {};
  SAC_RETURN_IF_ERROR(BuildShape(*header_, std::exchange(decoded_, {}), syntax_.harmonics, syntax_.handles_per_harmonic,
                                 LimitsOfIFrame(limits_, bytes_.i_frame_size), shape_));
  if (!SameFingerprint(Fingerprint(shape_.basis, shape_.patch_basis), syntax_.fingerprint)) {
    return Status::Unsupported("the harmonics computed here are not the encoder's");
  }
  return Status::Ok();
}

}  // namespace sac

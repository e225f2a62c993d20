// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/stream_start.h"

#include <algorithm>
#include <utility>

#include "codec/draco_mesh.h"
#include "codec/harmonics.h"
#include "codec/i_frame.h"
#include "codec/reconstruct.h"
#include "format/crc32.h"
#include "format/i_frame_syntax.h"

namespace sac {

Status StreamStart::CheckOrder(PacketType type) {
  const bool follows_header = std::exchange(follows_header_, false), is_i_frame = type == PacketType::kIFrame;
  if (!header_ || follows_header == is_i_frame) return Status::Ok();
  return damage_.Judge(
      Status::Corrupt(is_i_frame ? "an I-frame without its sequence header" : "a sequence header without an I-frame"));
}

Status StreamStart::TakeHeader(std::span<const std::uint8_t> payload) {
  if (header_ && !mesh_ && damage_.skips()) header_.reset();  // its I-frame is lost; another stream may be here
  if (header_) {
    follows_header_ = std::equal(payload.begin(), payload.end(), header_bytes_.begin(), header_bytes_.end());
    is_foreign_ = !follows_header_;
    if (!is_foreign_) return Status::Ok();
    return damage_.Judge(Status::Corrupt("a second sequence header that is not the first"));
  }
  SequenceHeader parsed;
  SAC_RETURN_IF_ERROR(ParseSequenceHeader(payload, limits_, parsed));
  header_ = parsed;
  info_ = InfoOf(parsed);
  header_bytes_.assign(payload.begin(), payload.end());
  follows_header_ = true;
  return Status::Ok();
}

Status StreamStart::TakeIFrame(std::span<const std::uint8_t> payload, bool& is_new) {
  is_new = false;
  const std::uint32_t crc = Crc32(payload);
  if (!header_) return damage_.Judge(Status::Corrupt("an I-frame before the sequence header"));
  if (mesh_) {
    is_foreign_ = is_foreign_ || crc != i_frame_crc_ || payload.size() != i_frame_size_;
    if (!is_foreign_) return Status::Ok();
    return damage_.Judge(Status::Corrupt("a second I-frame that is not the first"));
  }
  SAC_RETURN_IF_ERROR(DecodeIFrame(payload));
  i_frame_crc_ = crc;
  i_frame_size_ = payload.size();
  is_new = true;
  return Status::Ok();
}

Status StreamStart::DecodeIFrame(std::span<const std::uint8_t> payload) {
  IFrameSyntax syntax;
  SAC_RETURN_IF_ERROR(ParseIFrame(payload, *header_, syntax));
  DracoMesh draco;
  SAC_RETURN_IF_ERROR(DecodeDraco(syntax.mesh, *header_, draco));
  DecodedIFrame decoded;
  SAC_RETURN_IF_ERROR(AssembleIFrame(syntax, *header_, std::move(draco), decoded));
  Mesh out;
  out.triangles = decoded.mesh.triangles;
  out.uvs = std::move(decoded.uvs);
  out.uv_triangles = std::move(decoded.uv_triangles);
  out.normals = std::move(decoded.normals);
  out.normal_triangles = std::move(decoded.normal_triangles);
  out.colors = std::move(decoded.colors);
  SAC_RETURN_IF_ERROR(BuildShape(*header_, std::move(decoded.mesh), syntax.harmonics, syntax.samples_per_harmonic,
                                 LimitsOfIFrame(limits_, payload.size()), shape_));
  if (!SameFingerprint(Fingerprint(shape_.basis, shape_.patch_basis), syntax.fingerprint)) {
    return Status::Unsupported("the harmonics computed here are not the encoder's");
  }
  ToPositions(shape_.positions, out.positions);
  order_ = std::move(syntax.order);
  mesh_ = std::move(out);
  return Status::Ok();
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <string>

#include "codec/encode/c_input.h"
#include "geometry/c_status.h"
#include "geometry/frame_source_reader.h"
#include "sac/clip_encoder.h"
#include "sac/sac_encode.h"

namespace sac {
namespace {

void Tell(const EncodedClip& encoded, sac_clip_details& details) {
  if (details.order != nullptr) std::copy(encoded.order.begin(), encoded.order.end(), details.order);
  details.lost_texture_coordinates = encoded.lost_texture_coordinates ? 1 : 0;
  details.lost_normals = encoded.lost_normals ? 1 : 0;
  details.sted_spatial = encoded.distortion.sted_s;
  details.sted_temporal = encoded.distortion.sted_t;
  details.seam_gap = encoded.distortion.seam_gap;
}

Status Encode(const sac_input_mesh* mesh, const sac_frame_source* source, const sac_encoder_settings* settings,
              sac_byte_sink sink, void* sink_user, sac_clip_result& result, sac_clip_details* details) {
  if (source == nullptr || source->next == nullptr || source->rewind == nullptr || sink == nullptr) {
    return Status::InvalidArgument("a null pointer");
  }
  sac_encoder_settings s;
  SAC_RETURN_IF_ERROR(ReadSettings(settings, s));
  ClipEncoding encoding;
  encoding.encoder = ToEncoderSettings(s);
  encoding.targets = {Given(s.target_kg), Given(s.target_sted), Given(s.target_bpvf)};
  encoding.measure = s.unmeasured == 0;
  if (s.reference_rounds >= 0) encoding.reference_rounds = static_cast<std::uint32_t>(s.reference_rounds);
  if (s.progress != nullptr) {
    encoding.progress = [&s](const EncodingProgress& p) { return s.progress(s.user, p.trial, p.frames) == 0; };
  }
  Mesh first;
  SAC_RETURN_IF_ERROR(ReadMesh(mesh, first));
  FrameSourceReader clip(std::move(first), *source);
  const auto write = [&](std::span<const std::uint8_t> bytes) {
    return sink(sink_user, bytes.data(), bytes.size()) == 0 ? Status::Ok()
                                                            : Status::InvalidArgument("the sink ended it");
  };
  EncodedClip encoded;
  SAC_RETURN_IF_ERROR(EncodeClip(clip, encoding, write, encoded));
  result.bytes = encoded.bytes;
  result.frames = encoded.frames;
  result.trials = encoded.trials;
  result.bpvf = encoded.frames > 0 ? encoded.bpvf() : 0;
  result.kg = encoded.distortion.kg;
  result.sted = encoded.distortion.sted;
  result.max_error = encoded.distortion.max_error;
  result.parts = ToStreamBytes(encoded.parts);
  if (details != nullptr) Tell(encoded, *details);
  return Status::Ok();
}

}  // namespace
}  // namespace sac

sac_status sac_encode_clip(const sac_input_mesh* mesh, const sac_frame_source* source,
                           const sac_encoder_settings* settings, sac_byte_sink sink, void* sink_user,
                           sac_clip_result* result) {
  return sac_encode_clip_details(mesh, source, settings, sink, sink_user, result, nullptr);
}

sac_status sac_encode_clip_details(const sac_input_mesh* mesh, const sac_frame_source* source,
                                   const sac_encoder_settings* settings, sac_byte_sink sink, void* sink_user,
                                   sac_clip_result* result, sac_clip_details* details) {
  sac_clip_result unused;
  sac_clip_result& out = result != nullptr ? *result : unused;
  out = {};
  try {
    const sac::Status status = sac::Encode(mesh, source, settings, sink, sink_user, out, details);
    status.message().copy(out.message, sizeof(out.message) - 1);
    return sac::CodeOf(status);
  } catch (const std::exception&) {
    std::strcpy(out.message, "out of memory");
    return SAC_LIMIT;
  }
}

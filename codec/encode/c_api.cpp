// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "codec/encode/c_input.h"
#include "geometry/c_status.h"
#include "sac/encoder.h"
#include "sac/sac_encode.h"

struct sac_encoder {
  std::unique_ptr<sac::Encoder> encoder;  // null when sac_encoder_open() failed
  std::vector<sac::Vec3f> positions;      // the frame that is being sent
  std::vector<std::uint8_t> taken;        // the bytes that sac_encoder_take() gave out last
  std::string message;                    // message of the last call that failed
};

namespace {

using sac::Status;

// Runs `step` and turns exceptions into a status, since none may enter C code.
template <class Step>
sac_status Run(sac_encoder* encoder, Step&& step) {
  if (encoder == nullptr) return SAC_INVALID_ARGUMENT;
  try {
    const Status status = step();
    if (!status.ok()) encoder->message = status.message();
    return sac::CodeOf(status);
  } catch (const std::exception&) {
    encoder->message.clear();
    return SAC_LIMIT;
  }
}

// The same, but fails when the encoder could not be opened.
template <class Step>
sac_status RunOpen(sac_encoder* encoder, Step&& step) {
  return Run(encoder, [&] {
    return encoder->encoder ? step(*encoder->encoder) : Status::InvalidArgument("the encoder could not be opened");
  });
}

Status Open(const sac_input_mesh* mesh, const sac_encoder_settings* settings, sac_encoder& encoder) {
  sac_encoder_settings s;
  SAC_RETURN_IF_ERROR(sac::ReadSettings(settings, s));
  for (const double target : {s.target_kg, s.target_sted, s.target_bpvf}) {
    if (sac::Given(target)) return Status::InvalidArgument("targets take the whole clip: call sac_encode_clip()");
  }
  sac::EncoderSettings to = sac::ToEncoderSettings(s);
  if (s.progress != nullptr) {
    to.progress = [call = s.progress, user = s.user](std::uint32_t frames) { return call(user, 0, frames) == 0; };
  }
  sac::Mesh first;
  SAC_RETURN_IF_ERROR(sac::ReadMesh(mesh, first));
  encoder.positions.resize(first.positions.size());
  return sac::Encoder::Create(first, to, encoder.encoder);
}

}  // namespace

void sac_encoder_settings_init(sac_encoder_settings* settings) {
  if (settings == nullptr) return;
  constexpr double kChosen = std::numeric_limits<double>::quiet_NaN();
  const sac::EncoderSettings defaults;
  *settings = {};
  settings->struct_size = sizeof(sac_encoder_settings);
  settings->quality = defaults.quality;
  settings->max_error = settings->target_kg = settings->target_sted = settings->target_bpvf = kChosen;
  settings->motion_step = settings->displacement_step = settings->detail_step = settings->position_bits = kChosen;
  settings->reach = kChosen;
  settings->level_growth = defaults.level_growth;
  settings->handles_per_harmonic = defaults.handles_per_harmonic;
  settings->group = defaults.group;
  settings->pyramid = defaults.pyramid;
  settings->frame_rate_denominator = defaults.frame_rate_denominator;
  settings->index = defaults.index ? 1 : 0;
  settings->max_memory = defaults.limits.memory;
  settings->reference_rounds = -1;
  settings->up_axis = settings->loops = settings->join = -1;
  settings->threads = defaults.threads;
}

sac_status sac_encoder_open(sac_encoder** encoder, const sac_input_mesh* mesh, const sac_encoder_settings* settings) {
  if (encoder == nullptr) return SAC_INVALID_ARGUMENT;
  *encoder = new (std::nothrow) sac_encoder;
  if (*encoder == nullptr) return SAC_LIMIT;
  return Run(*encoder, [&] { return Open(mesh, settings, **encoder); });
}

void sac_encoder_close(sac_encoder* encoder) { delete encoder; }

sac_status sac_encoder_send(sac_encoder* encoder, const float* positions, size_t stride) {
  return RunOpen(encoder, [&](sac::Encoder& e) {
    SAC_RETURN_IF_ERROR(sac::ReadPositions(positions, stride, encoder->positions));
    return e.Send(encoder->positions);
  });
}

sac_status sac_encoder_begin_segment(sac_encoder* encoder, const sac_input_mesh* mesh) {
  return RunOpen(encoder, [&](sac::Encoder& e) {
    sac::Mesh next;
    SAC_RETURN_IF_ERROR(sac::ReadMesh(mesh, next));
    std::vector<sac::Vec3f> positions(next.positions.size());
    SAC_RETURN_IF_ERROR(e.BeginSegment(next));
    encoder->positions = std::move(positions);
    return Status::Ok();
  });
}

sac_status sac_encoder_finish(sac_encoder* encoder) {
  return RunOpen(encoder, [](sac::Encoder& e) { return e.Finish(); });
}

sac_status sac_encoder_take(sac_encoder* encoder, const uint8_t** data, size_t* size) {
  return RunOpen(encoder, [&](sac::Encoder& e) {
    if (data == nullptr || size == nullptr) return Status::InvalidArgument("a null pointer");
    encoder->taken = e.TakeBytes();
    *data = encoder->taken.data();
    *size = encoder->taken.size();
    return Status::Ok();
  });
}

sac_status sac_encoder_order(const sac_encoder* encoder, const uint32_t** order) {
  if (encoder == nullptr || !encoder->encoder || order == nullptr) return SAC_INVALID_ARGUMENT;
  *order = encoder->encoder->order().data();
  return SAC_OK;
}

sac_status sac_encoder_stream_bytes(const sac_encoder* encoder, sac_stream_bytes* bytes) {
  if (encoder == nullptr || !encoder->encoder || bytes == nullptr) return SAC_INVALID_ARGUMENT;
  *bytes = sac::ToStreamBytes(encoder->encoder->stream_bytes());
  return SAC_OK;
}

const char* sac_encoder_message(const sac_encoder* encoder) {
  return encoder == nullptr ? "no encoder" : encoder->message.c_str();
}

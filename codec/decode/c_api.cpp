// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <string>

#include "codec/decode/c_job_runner.h"
#include "geometry/c_status.h"
#include "sac/decoder.h"
#include "sac/sac.h"
#include "sac/version.h"

struct sac_decoder {
  sac::Decoder decoder;
  std::string message;      // message of the last call that failed
  sac::BlendWeights blend;  // what sac_decoder_blend() gave out
};

namespace {

using sac::CodeOf;
using sac::Status;

// Runs `step` and turns exceptions into a status, since none may enter C code.
template <class Step>
sac_status Run(sac_decoder* decoder, Step&& step) {
  if (decoder == nullptr) return SAC_INVALID_ARGUMENT;
  try {
    Status status = step(decoder->decoder);
    const sac_status code = CodeOf(status);
    if (code != SAC_OK && code != SAC_NEED_MORE_DATA) decoder->message = status.message();
    return code;
  } catch (const std::exception&) {
    decoder->message.clear();
    return SAC_LIMIT;
  }
}

Status Missing() { return Status::InvalidArgument("a null pointer"); }

// Calls visit(member, limit) for each limit of the C settings and the same limit among `limits`.
template <class Settings, class Limits, class Visit>
void VisitLimits(Settings& settings, Limits& limits, Visit&& visit) {
  visit(settings.max_vertices, limits.vertices);
  visit(settings.max_memory, limits.memory);
  visit(settings.max_work, limits.work);
  visit(settings.max_triangles, limits.expert.triangles);
  visit(settings.max_harmonics, limits.expert.harmonics);
  visit(settings.max_frames_per_group, limits.expert.frames_per_group);
  visit(settings.max_packet_bytes, limits.expert.packet_bytes);
  visit(settings.max_group_values, limits.expert.group_values);
  visit(settings.max_basis_values, limits.expert.basis_values);
  visit(settings.max_factor_values, limits.expert.factor_values);
  visit(settings.max_free_work, limits.expert.free_work);
  visit(settings.max_work_per_byte, limits.expert.work_per_byte);
  visit(settings.max_frame_work, limits.expert.frame_work);
}

sac::VertexBuffer ToBuffer(const sac_vertex_buffer& b) {
  return {b.data, b.size, b.stride, b.format == SAC_INT16 ? sac::VertexFormat::kInt16 : sac::VertexFormat::kFloat32};
}

Status ToBuffers(const sac_frame_buffers* from, sac::FrameBuffers& to) {
  if (from == nullptr) return Status::Ok();
  if (from->positions.format > SAC_INT16 || from->normals.format > SAC_INT16) {
    return Status::InvalidArgument("a buffer of an unknown format");
  }
  to = {ToBuffer(from->positions), ToBuffer(from->normals)};
  return Status::Ok();
}

void Describe(const sac::FrameInfo& from, sac_frame_info* to) {
  if (to == nullptr) return;
  to->index = from.index;
  to->intra = from.intra ? 1 : 0;
  to->time = from.time;
  std::copy(from.box.low.begin(), from.box.low.end(), to->box_low);
  std::copy(from.box.high.begin(), from.box.high.end(), to->box_high);
}

// The size of sac_settings in the first version of the interface, the least that a caller may give.
constexpr std::size_t kFirstSettings = offsetof(sac_settings, max_frame_work) + sizeof(sac_settings::max_frame_work);

// The values of an array of arrays as one array for C; null when there are none.
template <class Out, class In>
const Out* Flat(const std::vector<In>& values) {
  static_assert(sizeof(In) % sizeof(Out) == 0 && alignof(In) == alignof(Out));
  return values.empty() ? nullptr : reinterpret_cast<const Out*>(values.data());
}

}  // namespace

const char* sac_version(void) { return SAC_VERSION_STRING; }

const char* sac_stream_version(void) { return SAC_STREAM_VERSION_STRING; }

void sac_settings_init(sac_settings* settings) {
  if (settings == nullptr) return;
  const sac::DecoderSettings defaults;
  *settings = {};
  settings->struct_size = sizeof(sac_settings);
  VisitLimits(*settings, defaults.limits, [](auto& member, const auto& limit) { member = limit; });
  settings->skip_damage = defaults.skip_damage ? 1 : 0;
  settings->frame_step = defaults.frame_step;
  settings->threads = defaults.threads;
  settings->layers = defaults.layers;
}

sac_status sac_decoder_open(sac_decoder** decoder, const sac_settings* settings) {
  if (decoder == nullptr) return SAC_INVALID_ARGUMENT;
  *decoder = nullptr;
  sac_settings s;
  sac_settings_init(&s);
  if (settings != nullptr) {
    if (settings->struct_size < kFirstSettings) return SAC_INVALID_ARGUMENT;
    if (settings->struct_size > sizeof(s)) return SAC_UNSUPPORTED;
    std::memcpy(&s, settings, settings->struct_size);  // settings of an older version have fewer members
  }
  sac::DecoderSettings to;
  bool good = s.frame_step > 0 && s.threads <= 1024;
  VisitLimits(s, to.limits, [&](const auto& member, auto& limit) {
    good = good && member >= 0;  // false for NaN, too
    limit = member;
  });
  if (!good) return SAC_INVALID_ARGUMENT;
  to.skip_damage = s.skip_damage != 0;
  to.frame_step = s.frame_step;
  to.threads = s.threads;
  to.layers = s.layers;
  try {
    if (s.run_jobs != nullptr) to.run_jobs = sac::CJobRunner{s.run_jobs, s.run_jobs_user};
    *decoder = new sac_decoder{sac::Decoder(to), {}, {}};
    return SAC_OK;
  } catch (const std::exception&) {
    return SAC_LIMIT;
  }
}

void sac_decoder_close(sac_decoder* decoder) { delete decoder; }

void sac_decoder_reset(sac_decoder* decoder) {
  (void)Run(decoder, [&](sac::Decoder& d) {
    d.Reset();
    decoder->message.clear();
    return Status::Ok();
  });
}

sac_status sac_decoder_send(sac_decoder* decoder, const uint8_t** data, size_t* size) {
  return Run(decoder, [&](sac::Decoder& d) {
    if (data == nullptr || size == nullptr || (*data == nullptr && *size > 0)) return Missing();
    std::span<const std::uint8_t> bytes(*data, *size);
    Status status = d.Send(bytes);
    *data = bytes.data();
    *size = bytes.size();
    return status;
  });
}

sac_status sac_decoder_receive(sac_decoder* decoder, const sac_frame_buffers* buffers, sac_frame_info* info) {
  return Run(decoder, [&](sac::Decoder& d) {
    sac::FrameBuffers to;
    sac::FrameInfo described;
    SAC_RETURN_IF_ERROR(ToBuffers(buffers, to));
    SAC_RETURN_IF_ERROR(d.Receive(to, described));
    Describe(described, info);
    return Status::Ok();
  });
}

sac_status sac_decoder_finish(sac_decoder* decoder) {
  return Run(decoder, [](sac::Decoder& d) { return d.Finish(); });
}

sac_status sac_decoder_mesh(sac_decoder* decoder, sac_mesh* mesh) {
  return Run(decoder, [&](sac::Decoder& d) {
    if (mesh == nullptr) return Missing();
    if (d.mesh() == nullptr) return Status::NeedMoreData();
    const sac::Mesh& m = *d.mesh();
    mesh->vertices = static_cast<std::uint32_t>(m.positions.size());
    mesh->triangles = static_cast<std::uint32_t>(m.triangles.size());
    mesh->uvs = static_cast<std::uint32_t>(m.uvs.size());
    mesh->frame_rate_numerator = d.info()->frame_rate_numerator;
    mesh->frame_rate_denominator = d.info()->frame_rate_denominator;
    mesh->triangle_vertices = Flat<std::uint32_t>(m.triangles);
    mesh->uv_values = Flat<float>(m.uvs);
    mesh->triangle_uvs = Flat<std::uint32_t>(m.uv_triangles);
    mesh->normals = m.normal_triangles.empty() ? Flat<float>(m.normals) : nullptr;
    mesh->colors = Flat<std::uint8_t>(m.colors);
    mesh->order = Flat<std::uint32_t>(d.order());
    return Status::Ok();
  });
}

sac_status sac_decoder_segment(sac_decoder* decoder, uint32_t* segment) {
  return Run(decoder, [&](sac::Decoder& d) {
    if (segment == nullptr) return Missing();
    if (!d.segment()) return Status::NeedMoreData();
    *segment = *d.segment();
    return Status::Ok();
  });
}

sac_status sac_decoder_still(sac_decoder* decoder, const float** positions) {
  return Run(decoder, [&](sac::Decoder& d) {
    if (positions == nullptr) return Missing();
    if (d.mesh() == nullptr) return Status::NeedMoreData();
    *positions = Flat<float>(d.mesh()->positions);
    return Status::Ok();
  });
}

sac_status sac_decoder_prepare(sac_decoder* decoder) {
  return Run(decoder, [](sac::Decoder& d) { return d.Prepare(); });
}

sac_status sac_decoder_flush(sac_decoder* decoder) {
  return Run(decoder, [](sac::Decoder& d) { return d.Flush(); });
}

sac_status sac_decoder_metadata(sac_decoder* decoder, sac_metadata* metadata) {
  return Run(decoder, [&](sac::Decoder& d) {
    if (metadata == nullptr) return Missing();
    if (d.metadata() == nullptr) return Status::NeedMoreData();
    const sac::Metadata& m = *d.metadata();
    *metadata = {};
    metadata->name = m.name.empty() ? nullptr : m.name.c_str();
    metadata->json = m.json.empty() ? nullptr : m.json.c_str();
    metadata->metres_per_unit = m.metres_per_unit.value_or(0);
    metadata->up_axis = m.up_axis ? *m.up_axis : -1;
    metadata->first_frame = m.first_frame.value_or(0);
    metadata->loops = m.loops ? (*m.loops ? 1 : 0) : -1;
    metadata->has_bounds = m.bounds ? 1 : 0;
    if (m.bounds) {
      std::copy(m.bounds->low.begin(), m.bounds->low.end(), metadata->box_low);
      std::copy(m.bounds->high.begin(), m.bounds->high.end(), metadata->box_high);
    }
    return Status::Ok();
  });
}

sac_status sac_decoder_corner_normals(sac_decoder* decoder, const float** normals, uint32_t* count,
                                      const uint32_t** triangle_normals) {
  return Run(decoder, [&](sac::Decoder& d) {
    if (normals == nullptr || count == nullptr || triangle_normals == nullptr) return Missing();
    if (d.mesh() == nullptr) return Status::NeedMoreData();
    const sac::Mesh& m = *d.mesh();
    const bool of_corners = !m.normal_triangles.empty();
    *normals = of_corners ? Flat<float>(m.normals) : nullptr;
    *count = of_corners ? static_cast<std::uint32_t>(m.normals.size()) : 0;
    *triangle_normals = Flat<std::uint32_t>(m.normal_triangles);
    return Status::Ok();
  });
}

sac_status sac_decoder_offset(sac_decoder* decoder, double offset[3]) {
  return Run(decoder, [&](sac::Decoder& d) {
    if (offset == nullptr) return Missing();
    if (d.info() == nullptr) return Status::NeedMoreData();
    std::copy(d.info()->offset.begin(), d.info()->offset.end(), offset);
    return Status::Ok();
  });
}

sac_status sac_decoder_seek(sac_decoder* decoder, uint32_t frame, uint64_t* byte) {
  return Run(decoder, [&](sac::Decoder& d) { return byte == nullptr ? Missing() : d.Seek(frame, *byte); });
}

sac_status sac_decoder_seek_time(sac_decoder* decoder, double seconds, uint64_t* byte) {
  return Run(decoder, [&](sac::Decoder& d) { return byte == nullptr ? Missing() : d.SeekTime(seconds, *byte); });
}

sac_status sac_decoder_add_index(sac_decoder* decoder, const uint8_t* tail, size_t size, size_t* needed) {
  return Run(decoder, [&](sac::Decoder& d) {
    return needed == nullptr || (tail == nullptr && size > 0) ? Missing() : d.AddIndex({tail, size}, *needed);
  });
}

sac_status sac_decoder_interpolate(sac_decoder* decoder, double frame_time, const sac_frame_buffers* buffers,
                                   sac_frame_info* info) {
  return Run(decoder, [&](sac::Decoder& d) {
    sac::FrameBuffers to;
    sac::FrameInfo described;
    SAC_RETURN_IF_ERROR(ToBuffers(buffers, to));
    SAC_RETURN_IF_ERROR(d.Interpolate(frame_time, to, described));
    Describe(described, info);
    return Status::Ok();
  });
}

sac_status sac_decoder_blend(sac_decoder* decoder, sac_blend* blend) {
  return Run(decoder, [&](sac::Decoder& d) {
    if (blend == nullptr) return Missing();
    SAC_RETURN_IF_ERROR(d.Blend(decoder->blend));
    const sac::BlendWeights& b = decoder->blend;
    *blend = {b.handle_count, static_cast<std::uint32_t>(b.handles.size()), b.first.data(), b.handles.data(),
              b.weights.data()};
    return Status::Ok();
  });
}

sac_status sac_decoder_receive_handles(sac_decoder* decoder, float* matrices, size_t count, sac_frame_info* info,
                                       uint32_t* exact) {
  return Run(decoder, [&](sac::Decoder& d) {
    if (matrices == nullptr) return Missing();
    sac::FrameInfo described;
    bool is_exact = false;
    SAC_RETURN_IF_ERROR(d.ReceiveHandles({matrices, count}, described, is_exact));
    Describe(described, info);
    if (exact != nullptr) *exact = is_exact ? 1 : 0;
    return Status::Ok();
  });
}

sac_status sac_decoder_interpolate_handles(sac_decoder* decoder, double frame_time, float* matrices, size_t count,
                                           sac_frame_info* info, uint32_t* exact) {
  return Run(decoder, [&](sac::Decoder& d) {
    if (matrices == nullptr) return Missing();
    sac::FrameInfo described;
    bool is_exact = false;
    SAC_RETURN_IF_ERROR(d.InterpolateHandles(frame_time, {matrices, count}, described, is_exact));
    Describe(described, info);
    if (exact != nullptr) *exact = is_exact ? 1 : 0;
    return Status::Ok();
  });
}

uint32_t sac_decoder_layers(const sac_decoder* decoder) { return decoder == nullptr ? 0 : decoder->decoder.layers(); }

sac_status sac_decoder_frames(sac_decoder* decoder, uint32_t* frames) {
  return Run(decoder, [&](sac::Decoder& d) {
    if (frames == nullptr) return Missing();
    if (!d.frames()) return Status::NeedMoreData();
    *frames = *d.frames();
    return Status::Ok();
  });
}

size_t sac_decoder_lost_count(const sac_decoder* decoder) {
  return decoder == nullptr ? 0 : decoder->decoder.lost_frames().size();
}

sac_status sac_decoder_lost(const sac_decoder* decoder, size_t index, uint32_t* first, uint32_t* count) {
  if (first == nullptr || count == nullptr || index >= sac_decoder_lost_count(decoder)) return SAC_INVALID_ARGUMENT;
  const sac::FrameRange& range = decoder->decoder.lost_frames()[index];
  *first = range.first;
  *count = range.count;
  return SAC_OK;
}

const char* sac_decoder_message(const sac_decoder* decoder) {
  return decoder == nullptr ? "no decoder" : decoder->message.c_str();
}

// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/c_input.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <optional>

#include "codec/decode/c_job_runner.h"

namespace sac {
namespace {

// The size of sac_encoder_settings in the first version of the interface, the least that a caller may give.
constexpr std::size_t kFirstSettings = offsetof(sac_encoder_settings, user) + sizeof(sac_encoder_settings::user);

// Copies `count` values from an array of numbers. Copies nothing when `from` is null.
template <class Value, class Number>
void Copy(const Number* from, std::size_t count, std::vector<Value>& to) {
  static_assert(sizeof(Value) % sizeof(Number) == 0);
  if (from == nullptr) return;
  to.resize(count);
  if (count > 0) std::memcpy(to.data(), from, count * sizeof(Value));
}

Status Missing(const char* what) { return Status::InvalidArgument(std::string("mesh: no ") + what); }

}  // namespace

std::optional<double> Given(double value) { return std::isnan(value) ? std::nullopt : std::optional(value); }

Status ReadSettings(const sac_encoder_settings* from, sac_encoder_settings& settings) {
  sac_encoder_settings_init(&settings);
  if (from == nullptr) return Status::Ok();
  if (from->struct_size < kFirstSettings) {
    return Status::InvalidArgument("settings that sac_encoder_settings_init() has not set");
  }
  if (from->struct_size > sizeof(settings)) return Status::Unsupported("settings of a later library");
  std::memcpy(&settings, from, from->struct_size);
  return Status::Ok();
}

EncoderSettings ToEncoderSettings(const sac_encoder_settings& s) {
  EncoderSettings to;
  to.quality = s.quality;
  to.max_error = Given(s.max_error);
  to.motion_step = Given(s.motion_step);
  to.displacement_step = Given(s.displacement_step);
  to.detail_step = Given(s.detail_step);
  to.position_bits = Given(s.position_bits);
  to.level_growth = s.level_growth;
  if (s.harmonics != 0) to.harmonics = s.harmonics;
  to.handles_per_harmonic = s.handles_per_harmonic;
  to.group = s.group;
  to.pyramid = s.pyramid;
  to.low_delay = s.low_delay != 0;
  to.reference_shape = s.reference_previous != 0 ? ReferenceShape::kPrevious : ReferenceShape::kKey;
  to.frame_rate_numerator = s.frame_rate_numerator;
  to.frame_rate_denominator = s.frame_rate_denominator;
  to.keep_order = s.keep_order != 0;
  to.reach = Given(s.reach);
  if (s.join >= 0) to.join = s.join != 0;
  to.index = s.index != 0;
  to.repeat_start = s.repeat_start;
  to.limits.memory = s.max_memory;
  to.base_levels = s.base_levels;
  to.bounds = s.bounds != 0;
  to.threads = s.threads;
  if (s.run_jobs != nullptr) to.run_jobs = CJobRunner{s.run_jobs, s.run_jobs_user};
  if (s.name != nullptr) to.metadata.name = s.name;
  if (s.json != nullptr) to.metadata.json = s.json;
  if (s.metres_per_unit != 0) to.metadata.metres_per_unit = s.metres_per_unit;
  if (s.up_axis >= 0) to.metadata.up_axis = static_cast<std::uint8_t>(std::min(s.up_axis, 255));
  if (s.loops >= 0) to.metadata.loops = s.loops != 0;
  if (s.has_first_frame != 0) to.metadata.first_frame = s.first_frame;
  std::copy(std::begin(s.offset), std::end(s.offset), to.offset.begin());
  return to;
}

Status ReadPositions(const float* from, std::size_t stride, std::span<Vec3f> positions) {
  if (stride == 0) stride = sizeof(Vec3f);
  if (stride < sizeof(Vec3f)) {
    return Status::InvalidArgument("a stride of " + std::to_string(stride) + " bytes, a vertex has 12");
  }
  if (from == nullptr && !positions.empty()) return Status::InvalidArgument("positions: a null pointer");
  const auto* bytes = reinterpret_cast<const unsigned char*>(from);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    std::memcpy(positions[v].data(), bytes + v * stride, sizeof(Vec3f));
  }
  return Status::Ok();
}

Status ReadMesh(const sac_input_mesh* from, Mesh& mesh) {
  if (from == nullptr) return Status::InvalidArgument("mesh: a null pointer");
  if (from->triangles > 0 && from->triangle_vertices == nullptr) return Missing("triangle_vertices");
  if ((from->uvs > 0) != (from->uv_values != nullptr)) return Missing("uv_values, or uvs is 0");
  if ((from->uv_values == nullptr) != (from->triangle_uvs == nullptr)) return Missing("triangle_uvs, or no uv_values");
  if ((from->corner_normals > 0) != (from->triangle_normals != nullptr)) {
    return Missing("triangle_normals, or corner_normals is 0");
  }
  if (from->corner_normals > 0 && from->normals == nullptr) return Missing("normals, or corner_normals is not 0");
  const Limits limits;  // the default limits: larger meshes are refused before their arrays are copied
  if (from->vertices > limits.vertices || from->triangles > limits.expert.triangles) {
    return Status::Limit("mesh: more vertices or triangles than streams may have");
  }
  mesh.positions.resize(from->vertices);
  SAC_RETURN_IF_ERROR(ReadPositions(from->positions, from->position_stride, mesh.positions));
  Copy(from->triangle_vertices, from->triangles, mesh.triangles);
  Copy(from->uv_values, from->uvs, mesh.uvs);
  Copy(from->triangle_uvs, from->triangles, mesh.uv_triangles);
  Copy(from->normals, from->corner_normals > 0 ? from->corner_normals : from->vertices, mesh.normals);
  Copy(from->triangle_normals, from->triangles, mesh.normal_triangles);
  Copy(from->colors, from->vertices, mesh.colors);
  return Status::Ok();
}

sac_stream_bytes ToStreamBytes(const StreamBytes& bytes) {
  return {bytes.header, bytes.i_frame, bytes.motion, bytes.displacement, bytes.detail, bytes.correction, bytes.side};
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "codec/encode/input_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

namespace sac {
namespace {

constexpr std::size_t kMaxText = 1 << 20;  // bytes

// Whether `corners`, if there are any, are those of all triangles and index `count` values named `what`.
Status CheckCorners(const Mesh& mesh, const std::vector<Triangle>& corners, std::size_t count,
                    const std::string& what) {
  if (corners.empty()) return Status::Ok();
  if (corners.size() != mesh.triangles.size()) return Status::InvalidArgument(what + "s for some triangles only");
  for (const Triangle& t : corners) {
    if (std::max({t[0], t[1], t[2]}) >= count) return Status::InvalidArgument("a corner of a missing " + what);
  }
  return Status::Ok();
}

Status CheckPackets(const EncoderSettings& s) {
  if (s.metadata.metres_per_unit && !(std::isfinite(*s.metadata.metres_per_unit) && *s.metadata.metres_per_unit > 0)) {
    return Status::InvalidArgument("the length of a unit must be positive");
  }
  if (s.metadata.up_axis.value_or(0) > 2) return Status::InvalidArgument("the up axis must be from 0 to 2");
  if (std::max(s.metadata.name.size(), s.metadata.json.size()) > kMaxText) {
    return Status::InvalidArgument("a name or metadata of more than " + std::to_string(kMaxText) + " bytes");
  }
  for (const ExtraPacket& packet : s.extra_packets) {
    if (packet.type < 8 || packet.type > 15) return Status::InvalidArgument("types of extra packets are from 8 to 15");
    if (packet.payload.size() > s.limits.expert.packet_bytes) {
      return Status::InvalidArgument("an extra packet larger than the limit");
    }
  }
  return Status::Ok();
}

}  // namespace

Status CheckSettings(const EncoderSettings& s) {
  const auto positive = [](const std::optional<double>& v) { return !v || (std::isfinite(*v) && *v > 0); };
  if (!(s.quality >= 0 && s.quality <= 100)) return Status::InvalidArgument("quality must be from 0 to 100");
  if (s.harmonics && *s.harmonics == 0) return Status::InvalidArgument("at least one harmonic is needed");
  if (s.handles_per_harmonic > 64) return Status::InvalidArgument("there are at most 64 handles a harmonic");
  if (s.group == 0 || s.group > s.limits.expert.frames_per_group) {
    return Status::InvalidArgument("a group holds from 1 to " + std::to_string(s.limits.expert.frames_per_group) +
                                   " frames");
  }
  if (s.pyramid == 0) return Status::InvalidArgument("a pyramid holds at least one frame");
  if (!(s.level_growth >= 1 && s.level_growth <= 2)) {
    return Status::InvalidArgument("the growth of steps from level to level must be from 1 to 2");
  }
  if (!positive(s.motion_step)) return Status::InvalidArgument("the motion step must be positive");
  if (!positive(s.displacement_step)) return Status::InvalidArgument("the displacement step must be positive");
  if (s.reach && !(*s.reach >= 0)) return Status::InvalidArgument("the reach must not be negative");
  if (s.detail_step && !(std::isfinite(*s.detail_step) && *s.detail_step >= 0)) {
    return Status::InvalidArgument("the detail step must not be negative");
  }
  if (!positive(s.max_error)) return Status::InvalidArgument("the largest error must be positive");
  if (s.position_bits && !(*s.position_bits >= 1 && *s.position_bits <= 24)) {
    return Status::InvalidArgument("position bits must be from 1 to 24");
  }
  if (!std::all_of(s.offset.begin(), s.offset.end(), [](double x) { return std::isfinite(x); })) {
    return Status::InvalidArgument("the offset is not finite");
  }
  if (s.frame_rate_denominator == 0) return Status::InvalidArgument("the frame rate's denominator is zero");
  if (s.base_levels > 0 && (s.low_delay || s.reference_shape == ReferenceShape::kPrevious)) {
    return Status::InvalidArgument("layers need B-frames measured against the mesh");
  }
  if (s.threads > 1024) return Status::InvalidArgument("there are at most 1024 threads");
  return CheckPackets(s);
}

Status CheckMesh(const Mesh& mesh, const Limits& limits) {
  const std::size_t n = mesh.positions.size();
  if (n == 0) return Status::InvalidArgument("the mesh has no vertices");
  if (n > limits.vertices || mesh.triangles.size() > limits.expert.triangles) {
    return Status::Limit("the mesh has more than " + std::to_string(limits.vertices) + " vertices or " +
                         std::to_string(limits.expert.triangles) + " triangles");
  }
  for (const Triangle& t : mesh.triangles) {
    if (std::max({t[0], t[1], t[2]}) >= n) return Status::InvalidArgument("a triangle of a missing vertex");
  }
  SAC_RETURN_IF_ERROR(CheckCorners(mesh, mesh.uv_triangles, mesh.uvs.size(), "texture coordinate"));
  const bool of_vertices = mesh.normal_triangles.empty();
  if ((of_vertices && !mesh.normals.empty() && mesh.normals.size() != n) ||
      (!mesh.colors.empty() && mesh.colors.size() != n)) {
    return Status::InvalidArgument("normals or colours for some vertices only");
  }
  SAC_RETURN_IF_ERROR(CheckCorners(mesh, mesh.normal_triangles, mesh.normals.size(), "normal"));
  // Draco ends the program when what it quantizes has no finite extent.
  const auto moderate = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](const auto& value) {
      return std::all_of(value.begin(), value.end(), [](float x) { return std::abs(x) <= 1e37f; });
    });
  };
  if (!moderate(mesh.uvs)) return Status::InvalidArgument("texture coordinates beyond 1e37, or not numbers");
  if (!moderate(mesh.normals)) return Status::InvalidArgument("normals beyond 1e37, or not numbers");
  return Status::Ok();
}

Status CheckFinite(std::span<const Vec3f> positions) {
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (const float x : positions[v]) {
      if (!std::isfinite(x)) return Status::InvalidArgument("vertex " + std::to_string(v) + ": not a finite number");
    }
  }
  return Status::Ok();
}

}  // namespace sac

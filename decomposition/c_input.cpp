// SPDX-License-Identifier: Apache-2.0
#include "decomposition/c_input.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace sac {
namespace {

Status ToDomain(std::uint32_t domain, ComponentDomain& to) {
  if (domain != SAC_DISPLACEMENT && domain != SAC_GRADIENT) {
    return Status::InvalidArgument("there is no domain " + std::to_string(domain));
  }
  to = domain == SAC_GRADIENT ? ComponentDomain::kGradient : ComponentDomain::kDisplacement;
  return Status::Ok();
}

Status ReadStrokes(const sac_decomposition_settings& from, std::vector<Stroke>& strokes) {
  std::vector<sac_stroke> given;
  SAC_RETURN_IF_ERROR(ReadArray(from.strokes, from.stroke_count, "strokes", given));
  for (const sac_stroke& stroke : given) {
    Stroke& to = strokes.emplace_back();
    if (stroke.name != nullptr) to.name = stroke.name;
    const std::string what = "stroke " + std::to_string(strokes.size() - 1);
    SAC_RETURN_IF_ERROR(ReadArray(stroke.vertices, stroke.count, what, to.vertices));
    if (stroke.displacements != nullptr) {
      SAC_RETURN_IF_ERROR(ReadArray(stroke.displacements, stroke.count, what, to.displacements));
    }
  }
  return Status::Ok();
}

Status ReadComponent(const sac_component& from, std::size_t channels, const std::string& what, SparseComponent& to) {
  if (from.name != nullptr) to.name = from.name;
  to.centre = from.centre;
  SAC_RETURN_IF_ERROR(ReadArray(from.indices, from.nodes, what + ", indices", to.nodes));
  return ReadArray(from.values, channels * from.nodes, what + ", values", to.values);
}

}  // namespace

RigidPose ToPose(const sac_rigid_pose& from) {
  RigidPose to;
  std::copy(std::begin(from.rotation), std::end(from.rotation), to.rotation.begin());
  std::copy(std::begin(from.translation), std::end(from.translation), to.translation.begin());
  return to;
}

sac_rigid_pose FromPose(const RigidPose& from) {
  sac_rigid_pose to;
  std::copy(from.rotation.begin(), from.rotation.end(), to.rotation);
  std::copy(from.translation.begin(), from.translation.end(), to.translation);
  return to;
}

Status ToDecompositionSettings(const sac_decomposition_settings* from, std::uint32_t vertices,
                               DecompositionSettings& to) {
  sac_decomposition_settings s;
  sac_decomposition_settings_init(&s);
  SAC_RETURN_IF_ERROR(ReadSettings(from, sizeof(s), s));
  SAC_RETURN_IF_ERROR(ToDomain(s.domain, to.domain));
  to.count = s.count;
  to.positive = s.positive != 0;
  to.sparsity = s.sparsity;
  to.near = s.support_begin;
  to.far = s.support_full;
  to.steep = s.steep;
  to.tolerance = s.tolerance;
  to.iterations = s.iterations;
  to.moving = s.moving;
  to.threads = s.threads;
  to.fit_positions = s.fit_weights != 0;
  to.field_memory = static_cast<std::size_t>(std::min<std::uint64_t>(s.field_memory, SIZE_MAX));
  switch (s.rest_shape) {
    case SAC_REST_FIRST_FRAME:
      to.rest_shape = RestShape::kFirstFrame;
      break;
    case SAC_REST_MEAN:
      to.rest_shape = RestShape::kMean;
      break;
    case SAC_REST_GIVEN:
      to.rest_shape = RestShape::kGiven;
      SAC_RETURN_IF_ERROR(ReadArray(s.rest, vertices, "rest", to.rest));
      break;
    default:
      return Status::InvalidArgument("there is no rest shape " + std::to_string(s.rest_shape));
  }
  SAC_RETURN_IF_ERROR(ReadStrokes(s, to.strokes));
  SAC_RETURN_IF_ERROR(ReadArray(s.still, s.still_count, "still", to.still));
  if (s.progress != nullptr) {
    to.progress = [call = s.progress, user = s.user](const DecompositionProgress& p) {
      return call(user, p.iteration, p.objective) == 0;
    };
  }
  return Status::Ok();
}

Status ReadComponentSet(const sac_component_set* from, SparseComponents& to) {
  if (from == nullptr) return Status::InvalidArgument("set: a null pointer");
  SAC_RETURN_IF_ERROR(ToDomain(from->domain, to.domain));
  to.positive = from->positive != 0;
  SAC_RETURN_IF_ERROR(ReadArray(from->rest, from->vertices, "rest", to.rest));
  SAC_RETURN_IF_ERROR(ReadArray(from->triangle_vertices, from->triangles, "triangle_vertices", to.triangles));
  std::vector<sac_component> components;
  SAC_RETURN_IF_ERROR(ReadArray(from->components, from->count, "components", components));
  for (const sac_component& component : components) {
    const std::string what = "component " + std::to_string(to.components.size());
    SAC_RETURN_IF_ERROR(ReadComponent(component, to.channels(), what, to.components.emplace_back()));
  }
  const std::size_t weights = std::size_t{from->frames} * from->count;
  if (from->count > 0 && weights / from->count != from->frames) return Status::Limit("too many weights");
  SAC_RETURN_IF_ERROR(ReadArray(from->weights, weights, "weights", to.weights));
  std::vector<sac_rigid_pose> track;
  SAC_RETURN_IF_ERROR(ReadArray(from->track, from->frames, "track", track));
  for (const sac_rigid_pose& pose : track) to.track.push_back(ToPose(pose));
  return ReadArray(from->still, from->still_count, "still", to.still);
}

Status ToDragSettings(const sac_drag_settings* from, std::size_t components, DragSettings& to) {
  sac_drag_settings s;
  sac_drag_settings_init(&s);
  SAC_RETURN_IF_ERROR(ReadSettings(from, sizeof(s), s));
  if (s.start != nullptr) SAC_RETURN_IF_ERROR(ReadArray(s.start, components, "start", to.start));
  to.pose = ToPose(s.pose);
  to.price = s.price;
  to.sparse = s.sparse != 0;
  to.bounded = s.bounded != 0;
  return Status::Ok();
}

}  // namespace sac

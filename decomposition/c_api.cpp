// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "decomposition/c_input.h"
#include "geometry/c_status.h"
#include "geometry/frame_source_reader.h"
#include "sac/component_poser.h"
#include "sac/sac_components.h"
#include "sac/sparse_components.h"

struct sac_components {
  std::unique_ptr<sac::ComponentPoser> poser;  // null when the components could not be made
  sac::DecompositionReport report;
  // What sac_components_get() gives out beside the poser's own.
  std::vector<sac_component> parts;
  std::vector<sac_rigid_pose> track;
  std::string message;  // message of the last call that failed
};

namespace {

using sac::Status;

// Runs `step` and turns exceptions into a status, since none may enter C code.
template <class Step>
sac_status Run(sac_components* components, Step&& step) {
  if (components == nullptr) return SAC_INVALID_ARGUMENT;
  try {
    const Status status = step();
    if (!status.ok()) components->message = status.message();
    return sac::CodeOf(status);
  } catch (const std::exception&) {
    components->message.clear();
    return SAC_LIMIT;
  }
}

// The same, but fails when the components could not be made.
template <class Step>
sac_status RunMade(sac_components* components, Step&& step) {
  return Run(components, [&] {
    return components->poser ? step(*components->poser) : Status::InvalidArgument("the components could not be made");
  });
}

// Makes a new handle, then its components.
template <class Step>
sac_status RunNew(sac_components** components, Step&& step) {
  if (components == nullptr) return SAC_INVALID_ARGUMENT;
  *components = new (std::nothrow) sac_components;
  if (*components == nullptr) return SAC_LIMIT;
  return Run(*components, [&] { return step(**components); });
}

Status Take(sac::SparseComponents found, sac_components& to) {
  std::unique_ptr<sac::ComponentPoser> poser;
  SAC_RETURN_IF_ERROR(sac::ComponentPoser::Create(std::move(found), poser));
  const sac::SparseComponents& c = poser->components();
  for (const sac::SparseComponent& part : c.components) {
    to.parts.push_back({part.name.c_str(), part.centre, static_cast<std::uint32_t>(part.nodes.size()),
                        part.nodes.data(), part.values.data()});
  }
  for (const sac::RigidPose& pose : c.track) to.track.push_back(sac::FromPose(pose));
  to.poser = std::move(poser);
  return Status::Ok();
}

Status MissingPointer() { return Status::InvalidArgument("a null pointer"); }

bool Reads(const sac_frame_source* source) {
  return source != nullptr && source->next != nullptr && source->rewind != nullptr;
}

// A clip of the mesh that the components have.
sac::FrameSourceReader ClipOf(const sac::SparseComponents& components, const sac_frame_source& source) {
  sac::Mesh mesh;
  mesh.positions = components.rest;
  mesh.triangles = components.triangles;
  return {std::move(mesh), source};
}

std::span<const float> Weights(const sac::ComponentPoser& poser, const float* weights) {
  return {weights, poser.components().components.size()};
}

const float* FloatsOf(const sac::Positions& positions) { return positions.front().data(); }

void Copy(const sac::Positions& from, float* to) { std::memcpy(to, FloatsOf(from), from.size() * sizeof(sac::Vec3f)); }

}  // namespace

void sac_decomposition_settings_init(sac_decomposition_settings* settings) {
  if (settings == nullptr) return;
  const sac::DecompositionSettings defaults;
  *settings = {};
  settings->struct_size = sizeof(sac_decomposition_settings);
  settings->domain = SAC_DISPLACEMENT;
  settings->count = defaults.count;
  settings->sparsity = defaults.sparsity;
  settings->support_begin = defaults.near;
  settings->support_full = defaults.far;
  settings->steep = defaults.steep;
  settings->tolerance = defaults.tolerance;
  settings->iterations = defaults.iterations;
  settings->moving = defaults.moving;
  settings->threads = defaults.threads;
  settings->rest_shape = SAC_REST_FIRST_FRAME;
  settings->fit_weights = defaults.fit_positions ? 1 : 0;
  settings->field_memory = defaults.field_memory;
}

sac_status sac_components_decompose(sac_components** components, uint32_t vertices, const uint32_t* triangle_vertices,
                                    uint32_t triangles, const sac_frame_source* source,
                                    const sac_decomposition_settings* settings) {
  return RunNew(components, [&](sac_components& made) {
    if (!Reads(source)) return MissingPointer();
    sac::DecompositionSettings to;
    SAC_RETURN_IF_ERROR(sac::ToDecompositionSettings(settings, vertices, to));
    sac::Mesh mesh;
    mesh.positions.resize(vertices);
    SAC_RETURN_IF_ERROR(sac::ReadArray(triangle_vertices, triangles, "triangles", mesh.triangles));
    sac::FrameSourceReader clip(std::move(mesh), *source);
    sac::SparseComponents found;
    SAC_RETURN_IF_ERROR(sac::DecomposeClip(clip, to, found, made.report));
    return Take(std::move(found), made);
  });
}

sac_status sac_components_open(sac_components** components, const sac_component_set* set) {
  return RunNew(components, [&](sac_components& made) {
    sac::SparseComponents given;
    SAC_RETURN_IF_ERROR(sac::ReadComponentSet(set, given));
    return Take(std::move(given), made);
  });
}

void sac_components_close(sac_components* components) { delete components; }

sac_status sac_components_get(sac_components* components, sac_component_set* set) {
  return RunMade(components, [&](const sac::ComponentPoser& poser) {
    if (set == nullptr) return MissingPointer();
    const sac::SparseComponents& c = poser.components();
    *set = {};
    set->domain = c.domain == sac::ComponentDomain::kGradient ? SAC_GRADIENT : SAC_DISPLACEMENT;
    set->positive = c.positive ? 1 : 0;
    set->vertices = static_cast<std::uint32_t>(c.rest.size());
    set->triangles = static_cast<std::uint32_t>(c.triangles.size());
    set->count = static_cast<std::uint32_t>(c.components.size());
    set->frames = static_cast<std::uint32_t>(c.frames());
    set->still_count = static_cast<std::uint32_t>(c.still.size());
    set->rest = FloatsOf(c.rest);
    set->triangle_vertices = c.triangles.empty() ? nullptr : c.triangles.front().data();
    set->components = components->parts.data();
    set->weights = c.weights.data();
    set->track = components->track.data();
    set->still = c.still.data();
    return Status::Ok();
  });
}

sac_status sac_components_report(sac_components* components, sac_decomposition_report* report) {
  return RunMade(components, [&](const sac::ComponentPoser&) {
    if (report == nullptr) return MissingPointer();
    const sac::DecompositionReport& r = components->report;
    *report = {};
    report->objective = r.objective.data();
    report->iterations = static_cast<std::uint32_t>(r.objective.size());
    report->converged = r.converged ? 1 : 0;
    report->residual_share = r.residual_share;
    report->nonzero_share = r.nonzero_share;
    report->dropped_energy = r.dropped_energy;
    report->columns = r.columns;
    report->loose_vertices = r.loose_vertices;
    return Status::Ok();
  });
}

sac_status sac_components_measure(sac_components* components, const sac_frame_source* source, double* erms,
                                  double* max_error) {
  return RunMade(components, [&](const sac::ComponentPoser& poser) {
    if (!Reads(source)) return MissingPointer();
    sac::FrameSourceReader clip = ClipOf(poser.components(), *source);
    sac::ReconstructionError error;
    SAC_RETURN_IF_ERROR(sac::MeasureComponents(clip, poser.components(), error));
    if (erms != nullptr) *erms = error.erms;
    if (max_error != nullptr) *max_error = error.max;
    return Status::Ok();
  });
}

sac_status sac_components_compose(sac_components* components, const float* weights, const sac_rigid_pose* pose,
                                  float* positions) {
  return RunMade(components, [&](const sac::ComponentPoser& poser) {
    if (positions == nullptr || (weights == nullptr && !poser.components().components.empty())) return MissingPointer();
    sac::Positions composed;
    SAC_RETURN_IF_ERROR(
        poser.Compose(Weights(poser, weights), pose != nullptr ? sac::ToPose(*pose) : sac::RigidPose{}, composed));
    Copy(composed, positions);
    return Status::Ok();
  });
}

sac_status sac_components_fit(sac_components* components, const float* shape, float* weights, sac_rigid_pose* pose) {
  return RunMade(components, [&](const sac::ComponentPoser& poser) {
    if (weights == nullptr && !poser.components().components.empty()) return MissingPointer();
    sac::Positions target;
    SAC_RETURN_IF_ERROR(sac::ReadArray(shape, poser.components().rest.size(), "shape", target));
    std::vector<float> fitted;
    sac::RigidPose found;
    SAC_RETURN_IF_ERROR(poser.Fit(target, fitted, found));
    std::copy(fitted.begin(), fitted.end(), weights);
    if (pose != nullptr) *pose = sac::FromPose(found);
    return Status::Ok();
  });
}

sac_status sac_components_fit_clip(sac_components** fitted, sac_components* components, const sac_frame_source* source,
                                   uint32_t threads, sac_decomposition_progress progress, void* user) {
  return RunNew(fitted, [&](sac_components& made) {
    if (components == nullptr || !components->poser || !Reads(source)) return MissingPointer();
    const sac::SparseComponents& from = components->poser->components();
    sac::FrameSourceReader clip = ClipOf(from, *source);
    const auto going_on = [&](std::uint32_t frames) { return progress == nullptr || progress(user, frames, 0) == 0; };
    sac::SparseComponents found;
    SAC_RETURN_IF_ERROR(sac::FitComponents(clip, from, threads, going_on, found));
    return Take(std::move(found), made);
  });
}

void sac_drag_settings_init(sac_drag_settings* settings) {
  if (settings == nullptr) return;
  const sac::DragSettings defaults;
  *settings = {};
  settings->struct_size = sizeof(sac_drag_settings);
  settings->sparse = defaults.sparse ? 1 : 0;
  settings->bounded = defaults.bounded ? 1 : 0;
  settings->price = defaults.price;
  settings->pose = sac::FromPose(defaults.pose);
}

sac_status sac_components_drag(sac_components* components, const sac_drag_target* targets, uint32_t count,
                               const sac_drag_settings* settings, float* weights) {
  return RunMade(components, [&](const sac::ComponentPoser& poser) {
    const std::size_t parts = poser.components().components.size();
    if (weights == nullptr && parts > 0) return MissingPointer();
    sac::DragSettings to;
    SAC_RETURN_IF_ERROR(sac::ToDragSettings(settings, parts, to));
    std::vector<sac_drag_target> given;
    SAC_RETURN_IF_ERROR(sac::ReadArray(targets, count, "targets", given));
    std::vector<sac::DragTarget> dragged;
    for (const sac_drag_target& t : given) {
      dragged.push_back({t.vertex, {t.position[0], t.position[1], t.position[2]}});
    }
    std::vector<float> found;
    SAC_RETURN_IF_ERROR(poser.Drag(dragged, to, found));
    std::copy(found.begin(), found.end(), weights);
    return Status::Ok();
  });
}

sac_status sac_components_edit(sac_components* components, const sac_component_edit* edits, uint32_t frame,
                               float* positions) {
  return RunMade(components, [&](const sac::ComponentPoser& poser) {
    const sac::SparseComponents& c = poser.components();
    if (edits == nullptr && !c.components.empty()) return MissingPointer();
    std::vector<sac::ComponentEdit> given(c.components.size());
    for (std::size_t k = 0; k < given.size(); ++k) {
      given[k].gain = edits[k].gain;
      given[k].offset = edits[k].offset;
      if (edits[k].curve != nullptr) given[k].curve.assign(edits[k].curve, edits[k].curve + c.frames());
    }
    sac::Positions edited;
    SAC_RETURN_IF_ERROR(sac::ReadArray(positions, c.rest.size(), "positions", edited));
    SAC_RETURN_IF_ERROR(sac::EditFrame(poser, given, frame, edited));
    Copy(edited, positions);
    return Status::Ok();
  });
}

const char* sac_components_message(const sac_components* components) {
  return components == nullptr ? "no components" : components->message.c_str();
}

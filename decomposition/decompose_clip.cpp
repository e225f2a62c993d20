// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "decomposition/alternation.h"
#include "decomposition/clip_field.h"
#include "decomposition/given_component.h"
#include "decomposition/poisson.h"
#include "decomposition/surface_distance.h"
#include "sac/component_poser.h"
#include "sac/sparse_components.h"

namespace sac {
namespace {

constexpr std::uint32_t kMostComponents = 4096;

Status CheckVertices(const ClipReader& clip, const std::vector<std::uint32_t>& vertices, const std::string& what) {
  const std::size_t count = clip.mesh().positions.size();
  for (const std::uint32_t v : vertices) {
    if (v >= count) {
      return Status::InvalidArgument(what + ": there is no vertex " + std::to_string(v) + " among " +
                                     std::to_string(count));
    }
  }
  return Status::Ok();
}

Status CheckStroke(const ClipReader& clip, const DecompositionSettings& settings, std::size_t index) {
  const Stroke& stroke = settings.strokes[index];
  const std::string name = stroke.name.empty() ? "stroke " + std::to_string(index) : "stroke " + stroke.name;
  if (stroke.vertices.empty()) return Status::InvalidArgument(name + ": no vertices");
  SAC_RETURN_IF_ERROR(CheckVertices(clip, stroke.vertices, name));
  if (stroke.displacements.empty()) return Status::Ok();
  if (settings.domain == ComponentDomain::kGradient) {
    return Status::InvalidArgument(name + ": displacements are for the displacement domain");
  }
  if (stroke.displacements.size() != stroke.vertices.size()) {
    return Status::InvalidArgument(name + ": " + std::to_string(stroke.displacements.size()) + " displacements for " +
                                   std::to_string(stroke.vertices.size()) + " vertices");
  }
  for (const Vec3f& d : stroke.displacements) {
    if (!std::isfinite(d[0]) || !std::isfinite(d[1]) || !std::isfinite(d[2])) {
      return Status::InvalidArgument(name + ": a displacement is not finite");
    }
  }
  return Status::Ok();
}

Status CheckSettings(const ClipReader& clip, const DecompositionSettings& s) {
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  if (s.count < 1 || s.count > kMostComponents) {
    return Status::InvalidArgument("the number of components is not from 1 to " + std::to_string(kMostComponents));
  }
  if (!(s.sparsity >= 0) || !std::isfinite(s.sparsity)) return Status::InvalidArgument("the sparsity is negative");
  if (!(s.near >= 0) || !positive(s.far) || !(s.near < s.far)) {
    return Status::InvalidArgument("the support's radii are not 0 <= near < far");
  }
  if (!(s.steep >= 1) || !std::isfinite(s.steep)) return Status::InvalidArgument("the ramp's top is below 1");
  if (s.iterations < 1 || !(s.tolerance >= 0)) return Status::InvalidArgument("no iterations, or a negative tolerance");
  const Mesh& mesh = clip.mesh();
  if (mesh.positions.empty()) return Status::InvalidArgument(AtClip(clip, "has no vertices"));
  for (const Triangle& t : mesh.triangles) {
    if (*std::max_element(t.begin(), t.end()) >= mesh.positions.size()) {
      return Status::InvalidArgument(AtClip(clip, "a triangle has a vertex that is not there"));
    }
  }
  if (s.domain == ComponentDomain::kGradient && mesh.triangles.empty()) {
    return Status::InvalidArgument(AtClip(clip, "has no triangles, which the gradient domain needs"));
  }
  if (s.rest_shape == RestShape::kGiven) {
    if (s.rest.size() != mesh.positions.size()) {
      return Status::InvalidArgument("the rest shape has " + std::to_string(s.rest.size()) + " vertices, not " +
                                     std::to_string(mesh.positions.size()));
    }
    if (!MatrixOf(s.rest).allFinite()) return Status::InvalidArgument("a coordinate of the rest shape is not finite");
  }
  if (s.strokes.size() > s.count) return Status::InvalidArgument("there are more strokes than components");
  for (std::size_t i = 0; i < s.strokes.size(); ++i) SAC_RETURN_IF_ERROR(CheckStroke(clip, s, i));
  return CheckVertices(clip, s.still, "still vertices");
}

// The triangles that touch one of `vertices`.
std::vector<std::uint32_t> TrianglesAt(const Mesh& mesh, const std::vector<std::uint32_t>& vertices) {
  std::vector<char> chosen(mesh.positions.size(), 0);
  for (const std::uint32_t v : vertices) chosen[v] = 1;
  std::vector<std::uint32_t> found;
  for (std::size_t j = 0; j < mesh.triangles.size(); ++j) {
    const Triangle& t = mesh.triangles[j];
    if (chosen[t[0]] != 0 || chosen[t[1]] != 0 || chosen[t[2]] != 0) found.push_back(static_cast<std::uint32_t>(j));
  }
  return found;
}

Status MakeSites(const Mesh& mesh, const DecompositionSettings& settings, const ClipField& read,
                 const SurfaceDistance& distance, AlternationSettings& alternation) {
  const bool gradient = settings.domain == ComponentDomain::kGradient;
  alternation.still = gradient ? TrianglesAt(mesh, settings.still) : settings.still;
  for (const Stroke& stroke : settings.strokes) {
    ComponentSite site;
    site.fixed = true;
    site.nodes = gradient ? TrianglesAt(mesh, stroke.vertices) : stroke.vertices;
    if (site.nodes.empty()) return Status::InvalidArgument("stroke " + stroke.name + ": touches no triangle");
    if (!stroke.displacements.empty()) {
      site.values = GivenComponent(stroke, settings, distance, *read.alignment, read.scale);
    }
    alternation.sites.push_back(std::move(site));
  }
  return Status::Ok();
}

AlternationSettings MakeAlternationSettings(const DecompositionSettings& s, double extent) {
  AlternationSettings a;
  a.count = s.count;
  a.sparsity = s.sparsity;
  a.near = s.near * extent;
  a.far = s.far * extent;
  a.steep = s.steep;
  a.positive = s.positive;
  a.iterations = s.iterations;
  a.moving = s.moving;
  a.tolerance = s.tolerance;
  a.threads = s.threads;
  if (s.progress) {
    a.progress = [&s](std::uint32_t iteration, double objective) {
      return s.progress({s.count, iteration, objective});
    };
  }
  return a;
}

SparseComponent MakeComponent(const NodeField& field, const Alternation& found, std::size_t k, double scale) {
  SparseComponent component;
  const std::size_t channels = field.channels;
  double largest = -1;
  for (std::size_t i = 0; i < field.nodes; ++i) {
    const float* c = found.components.data() + i * channels * found.count + k;
    double square = 0;
    for (std::size_t a = 0; a < channels; ++a) {
      square += static_cast<double>(c[a * found.count]) * static_cast<double>(c[a * found.count]);
    }
    if (square == 0) continue;
    component.nodes.push_back(static_cast<std::uint32_t>(i));
    for (std::size_t a = 0; a < channels; ++a) {
      component.values.push_back(static_cast<float>(scale * static_cast<double>(c[a * found.count])));
    }
    largest = std::max(largest, square);
  }
  component.centre = found.sites[k].nodes.front();
  return component;
}

void Collect(const ClipReader& clip, const DecompositionSettings& settings, const ClipField& read,
             const Alternation& found, SparseComponents& result, DecompositionReport& report) {
  result.domain = settings.domain;
  result.positive = settings.positive;
  result.rest = PositionsOf(read.alignment->rest());
  result.triangles = clip.mesh().triangles;
  result.track = read.track;
  result.rate = clip.rate();
  result.still = settings.still;
  std::size_t pairs = 0;
  for (std::size_t k = 0; k < found.count; ++k) {
    result.components.push_back(MakeComponent(read.field, found, k, read.scale));
    SparseComponent& component = result.components.back();
    pairs += component.nodes.size();
    const bool stroke = k < settings.strokes.size();
    component.name = stroke && !settings.strokes[k].name.empty()
                         ? settings.strokes[k].name
                         : (stroke ? "stroke " : "component ") + std::to_string(k);
    if (stroke) component.centre = found.sites[k].nodes.front();
  }
  result.weights.reserve(read.track.size() * found.count);
  for (Eigen::Index f = 0; f < found.weights.rows(); ++f) {
    for (Eigen::Index k = 0; k < found.weights.cols(); ++k) {
      result.weights.push_back(static_cast<float>(found.weights(f, k)));
    }
  }
  report.objective = found.objective;
  report.converged = found.converged;
  report.residual_share = found.square > 0 ? found.residual / found.square : 0;
  report.nonzero_share =
      static_cast<double>(pairs) / (static_cast<double>(read.field.nodes) * static_cast<double>(found.count));
  report.dropped_energy = read.field.dropped_energy;
  report.columns = static_cast<std::uint32_t>(read.field.columns);
}

// Vertices without area around them, and kInvalidArgument where none has any in the gradient domain.
Status CheckArea(const ClipReader& clip, const DecompositionSettings& settings, const ClipField& read,
                 DecompositionReport& report) {
  if (settings.domain == ComponentDomain::kDisplacement) return Status::Ok();
  PoissonReconstruction poisson;
  const Status status = poisson.Prepare(read.alignment->rest(), clip.mesh().triangles, settings.still);
  if (!status.ok()) return {status.code(), AtClip(clip, status.message())};
  report.loose_vertices = poisson.loose_vertices();
  return Status::Ok();
}

Status Decompose(ClipReader& clip, const DecompositionSettings& settings, SparseComponents& result,
                 DecompositionReport& report) {
  SAC_RETURN_IF_ERROR(CheckSettings(clip, settings));
  ClipField read;
  SAC_RETURN_IF_ERROR(ReadClipField(clip, settings, read));
  SAC_RETURN_IF_ERROR(CheckArea(clip, settings, read, report));
  const SurfaceDistance distance(read.alignment->rest(), clip.mesh().triangles);
  AlternationSettings alternation = MakeAlternationSettings(settings, read.alignment->extent());
  const bool gradient = settings.domain == ComponentDomain::kGradient;
  alternation.distance = [&](const std::vector<std::uint32_t>& nodes, double most) {
    if (gradient) return distance.FromTriangles(nodes, most);
    std::vector<SurfaceDistance::Seed> seeds;
    for (const std::uint32_t v : nodes) seeds.push_back({v, 0});
    return distance.From(seeds, most);
  };
  SAC_RETURN_IF_ERROR(MakeSites(clip.mesh(), settings, read, distance, alternation));
  Alternation found;
  SAC_RETURN_IF_ERROR(Alternate(read.field, alternation, found));
  Collect(clip, settings, read, found, result, report);
  if (!gradient || !settings.fit_positions) return Status::Ok();
  const auto going_on = [&](std::uint32_t) {
    return !settings.progress || settings.progress({settings.count, static_cast<std::uint32_t>(found.objective.size()),
                                                    found.objective.back()});
  };
  SparseComponents fitted;
  SAC_RETURN_IF_ERROR(FitComponents(clip, result, settings.threads, going_on, fitted));
  result = std::move(fitted);
  return Status::Ok();
}

}  // namespace

Status DecomposeClip(ClipReader& clip, const DecompositionSettings& settings, SparseComponents& result,
                     DecompositionReport& report) {
  result = {};
  report = {};
  try {
    return Decompose(clip, settings, result, report);
  } catch (const std::bad_alloc&) {
    return Status::Limit("not enough memory for this clip");
  }
}

}  // namespace sac

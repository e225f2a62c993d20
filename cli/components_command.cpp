// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/clip_argument.h"
#include "cli/commands.h"
#include "cli/component_count.h"
#include "cli/component_output.h"
#include "cli/distortion_report.h"
#include "cli/given_option.h"
#include "cli/number_option.h"
#include "cli/progress.h"
#include "cli/warning_report.h"
#include "files/component_file.h"
#include "files/component_tables.h"
#include "files/gltf/gltf_clip.h"
#include "files/mesh_file.h"
#include "files/overwriting.h"
#include "sac/component_poser.h"

namespace sac {
namespace {

struct ComponentsOptions {
  std::vector<std::string> inputs, outputs, strokes;
  std::string still, fit, report, domain = "displacement", rest = "first";
  std::optional<std::uint32_t> count;
  std::optional<double> error;
  DecompositionSettings settings;
  std::uint32_t field_megabytes = 2048;
  bool json = false, strict = false;
};

bool HasGltf(const ComponentsOptions& o) { return std::any_of(o.outputs.begin(), o.outputs.end(), IsGltfName); }

Status CheckOptions(const CLI::App& command, ComponentsOptions& o) {
  for (const std::string& path : o.outputs) SAC_RETURN_IF_ERROR(CheckComponentOutput(path));
  if (o.outputs.empty() && o.report.empty()) return Status::InvalidArgument("--output or --report is required");
  if (o.count && o.error) return Status::InvalidArgument("--count and --error exclude each other");
  if (!o.fit.empty()) {
    const std::string idle =
        FirstGiven(command, {"--count", "--error", "--domain", "--locality", "--positive", "--rest", "--stroke",
                             "--still", "--near", "--far", "--iterations", "--field-memory"});
    if (!idle.empty()) {
      return Status::InvalidArgument(idle + " has no effect with --fit, which takes the components of its file as " +
                                     "they are and finds weights alone");
    }
  }
  if (o.count) o.settings.count = *o.count;
  if (!(o.settings.near < o.settings.far)) return Status::InvalidArgument("--near is not below --far");
  if (o.domain == "gradient") o.settings.domain = ComponentDomain::kGradient;
  if (o.domain == "gradient" && HasGltf(o)) {
    return Status::InvalidArgument("a .glb cannot hold components of gradients, which are no morph targets");
  }
  std::vector<std::string> inputs = IsStreamName(o.inputs) ? o.inputs : FilesOfInput(o.inputs);
  inputs.insert(inputs.end(), o.strokes.begin(), o.strokes.end());
  for (const std::string& path : {o.still, o.fit}) {
    if (!path.empty()) inputs.push_back(path);
  }
  o.settings.field_memory = std::size_t{o.field_megabytes} << 20;
  std::vector<std::string> outputs = o.outputs;
  if (!o.report.empty()) outputs.push_back(PageOfReport(o.report));
  return CheckOverwriting(inputs, outputs);
}

// Reads what the settings name files for.
Status ReadSettings(const ComponentsOptions& o, DecompositionSettings& settings) {
  settings = o.settings;
  for (const std::string& path : o.strokes) {
    SAC_RETURN_IF_ERROR(ReadStroke(path, settings.strokes.emplace_back()));
  }
  if (!o.still.empty()) {
    Stroke still;
    SAC_RETURN_IF_ERROR(ReadStroke(o.still, still));
    if (!still.displacements.empty()) return Status::Corrupt(o.still + ": still vertices have no displacements");
    settings.still = std::move(still.vertices);
  }
  if (o.rest == "mean") settings.rest_shape = RestShape::kMean;
  if (o.rest == "first" || o.rest == "mean") return Status::Ok();
  settings.rest_shape = RestShape::kGiven;
  Mesh mesh;
  SAC_RETURN_IF_ERROR(ReadMesh(o.rest, mesh));
  settings.rest = std::move(mesh.positions);
  return Status::Ok();
}

// What a run came to.
struct Outcome {
  SparseComponents components;
  DecompositionReport report;
  ReconstructionError error;
  std::uint32_t decompositions = 0;
  double seconds = 0;
  double rounding = 0;  // of a .glb, model units
  Warnings warnings;
};

Status Decompose(const ComponentsOptions& o, ClipArgument& clip, Progress& progress, Outcome& outcome) {
  DecompositionSettings settings;
  SAC_RETURN_IF_ERROR(ReadSettings(o, settings));
  for (Vec3f& p : settings.rest) {
    for (std::size_t a = 0; a < 3; ++a) p[a] = static_cast<float>(static_cast<double>(p[a]) - clip.offset[a]);
  }
  settings.progress = [&](const DecompositionProgress& p) {
    progress.Begin(std::to_string(p.components) + " components, iteration " + std::to_string(p.iteration));
    return true;
  };
  if (o.error) {
    SAC_RETURN_IF_ERROR(DecomposeToError(*clip.reader, settings, *o.error, outcome.components, outcome.report,
                                         outcome.error, outcome.decompositions));
  } else {
    SAC_RETURN_IF_ERROR(DecomposeClip(*clip.reader, settings, outcome.components, outcome.report));
    SAC_RETURN_IF_ERROR(MeasureComponents(*clip.reader, outcome.components, outcome.error));
    outcome.decompositions = 1;
  }
  if (outcome.report.dropped_energy > 0) {
    char text[160];
    std::snprintf(text, sizeof text, ": %zu frames were reduced to %u to fit in memory, without %.2g of their energy",
                  outcome.components.frames(), outcome.report.columns, outcome.report.dropped_energy);
    outcome.warnings.push_back(clip.reader->name() + text);
  }
  if (outcome.report.loose_vertices > 0) {
    outcome.warnings.push_back(clip.reader->name() + ": " + std::to_string(outcome.report.loose_vertices) +
                               " vertices are in no triangle with an area: they move with the whole only");
  }
  const auto empty = std::count_if(outcome.components.components.begin(), outcome.components.components.end(),
                                   [](const SparseComponent& c) { return c.nodes.empty(); });
  if (empty > 0) {
    outcome.warnings.push_back(clip.reader->name() + ": " + std::to_string(empty) +
                               " components are empty: fewer explain the clip");
  }
  return Status::Ok();
}

Status Fit(const ComponentsOptions& o, ClipArgument& clip, Progress& progress, Outcome& outcome) {
  SparseComponents components;
  SAC_RETURN_IF_ERROR(ReadComponents(o.fit, components));
  if (components.domain == ComponentDomain::kGradient && HasGltf(o)) {
    return Status::InvalidArgument(o.fit + ": has components of gradients, which are no morph targets for a .glb");
  }
  const Mesh& mesh = clip.reader->mesh();
  if (mesh.positions.size() == components.rest.size() && mesh.triangles != components.triangles) {
    outcome.warnings.push_back(clip.reader->name() + ": its triangles are not those of " + o.fit +
                               "; vertices are taken for the same by their order");
  }
  progress.SetTotal(clip.reader->frame_count());
  const auto going_on = [&](std::uint32_t frames) {
    progress.FramesDone(frames);
    return true;
  };
  SAC_RETURN_IF_ERROR(FitComponents(*clip.reader, components, o.settings.threads, going_on, outcome.components));
  return MeasureComponents(*clip.reader, outcome.components, outcome.error);
}

Json OutcomeJson(const Outcome& outcome) {
  const SparseComponents& c = outcome.components;
  Json json;
  json["domain"] = c.domain == ComponentDomain::kGradient ? "gradient" : "displacement";
  json["components"] = c.components.size();
  json["frames"] = c.frames();
  json["vertices"] = c.rest.size();
  json["triangles"] = c.triangles.size();
  json["erms"] = outcome.error.erms;
  json["max_error"] = outcome.error.max;
  if (outcome.decompositions > 0) {
    json["nonzero_share"] = outcome.report.nonzero_share;
    json["residual_share"] = outcome.report.residual_share;
    json["objective"] = outcome.report.objective;
    json["converged"] = outcome.report.converged;
    json["columns"] = outcome.report.columns;
    json["dropped_energy"] = outcome.report.dropped_energy;
    json["decompositions"] = outcome.decompositions;
  }
  if (outcome.rounding > 0) json["gltf_rounding"] = outcome.rounding;
  json["seconds"] = outcome.seconds;
  json["warnings"] = outcome.warnings;
  return json;
}

void PrintOutcome(const Outcome& outcome) {
  const SparseComponents& c = outcome.components;
  std::printf("%zu components of %s, %zu frames, %zu vertices, %zu triangles\n", c.components.size(),
              c.domain == ComponentDomain::kGradient ? "deformation gradients" : "displacements", c.frames(),
              c.rest.size(), c.triangles.size());
  std::printf("Erms      %.4g (x 1000, longest side 1)\nmax error %.6g model units\n", outcome.error.erms,
              outcome.error.max);
  if (outcome.decompositions > 0) {
    std::printf("non-zero  %.3g %% of all pairs of %s and component\n", 100 * outcome.report.nonzero_share,
                c.domain == ComponentDomain::kGradient ? "triangle" : "vertex");
    std::printf("%zu iterations%s\n", outcome.report.objective.size(),
                outcome.report.converged ? "" : ", not converged");
  }
  if (outcome.rounding > 0) std::printf("rounding  %.3g model units at most, in the .glb\n", outcome.rounding);
  std::printf("%.2f seconds\n", outcome.seconds);
}

Status Run(const ComponentsOptions& o) {
  const auto start = std::chrono::steady_clock::now();
  Outcome outcome;
  {
    Progress progress;
    progress.Begin("reading");
    ClipArgument clip;
    SAC_RETURN_IF_ERROR(OpenClip(o.inputs, clip));
    SAC_RETURN_IF_ERROR(o.fit.empty() ? Decompose(o, clip, progress, outcome) : Fit(o, clip, progress, outcome));
    outcome.warnings.insert(outcome.warnings.begin(), clip.warnings.begin(), clip.warnings.end());
    if (clip.offset != std::array<double, 3>{}) {
      outcome.warnings.push_back(clip.reader->name() + ": the components' positions are relative to its offset " +
                                 std::to_string(clip.offset[0]) + " " + std::to_string(clip.offset[1]) + " " +
                                 std::to_string(clip.offset[2]));
    }
    progress.Begin("writing");
    if (o.strict) SAC_RETURN_IF_ERROR(TellWarnings(outcome.warnings, true));
    SAC_RETURN_IF_ERROR(WriteComponentOutputs(outcome.components, o.outputs, o.report,
                                              {clip.reader->name(), outcome.error}, outcome.rounding));
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  SAC_RETURN_IF_ERROR(TellWarnings(outcome.warnings, false));
  if (o.json) {
    std::fputs(JsonLine(OutcomeJson(outcome)).c_str(), stdout);
  } else {
    PrintOutcome(outcome);
  }
  return Status::Ok();
}

void AddShape(CLI::App& app, ComponentsOptions& o) {
  AddNumber(app, "--count", o.count, 1u, 4096u, "components [40]");
  AddNumber(
      app, "--error", o.error, 1e-6, 1e6,
      "find the fewest components whose Erms (x 1000, longest side 1) is at most this, by several decompositions");
  app.add_option("--domain", o.domain,
                 "displacement (of vertices; faces, cloth) or gradient (rotation and stretch of triangles; limbs) "
                 "[displacement]")
      ->check(CLI::IsMember(std::vector<std::string>{"displacement", "gradient"}))
      ->option_text("WHAT");
  AddNumber(app, "--locality", o.settings.sparsity, 0.0, 1e6, "larger: smaller components, larger error [0.03]");
  app.add_flag("--positive", o.settings.positive, "weights from 0 to 1, as for shape keys, not from -1 to 1");
  app.add_option("--rest", o.rest, "what is measured from: first (frame), mean, or a mesh file [first]")
      ->option_text("SHAPE");
  app.add_option("--stroke", o.strokes,
                 "a file of vertices, an index a line, that a component of its own grows from; with x y z behind each "
                 "index that component is given and moves them so; may be repeated")
      ->option_text("FILE");
  app.add_option("--still", o.still, "a file of vertices that no component moves")->option_text("FILE");
}

void AddExpert(CLI::App& app, ComponentsOptions& o) {
  AddNumber(app, "--near", o.settings.near, 0.0, 1e6, "radius within which a component costs nothing [0.1]");
  AddNumber(app, "--far", o.settings.far, 1e-9, 1e6,
            "radius from which it costs full price; both in square roots of the rest shape's area [0.5]");
  AddNumber(app, "--iterations", o.settings.iterations, 1u, 100000u, "at most [60]");
  AddNumber(app, "--threads", o.settings.threads, 0u, 1024u, "0: as many as the machine has [0]");
  AddNumber(app, "--field-memory", o.field_megabytes, 1u, 1u << 20,
            "megabytes for the values of all frames; what exceeds them is reduced, and told [2048]");
}

}  // namespace

Command AddComponentsCommand(CLI::App& app) {
  auto options = std::make_shared<ComponentsOptions>();
  CLI::App* command =
      app.add_subcommand("components", "Take a clip apart into sparse local components, each with a weight a frame.");
  AddClipArgument(*command, options->inputs, true);
  command
      ->add_option("-o,--output", options->outputs,
                   "c.npz (everything, also for numpy), c.glb (morph targets and their animation), c.csv (weights); "
                   "may be repeated")
      ->option_text("FILE");
  command
      ->add_option("--report", options->report,
                   "a directory for components.html, one page with all in it: each component as colours on the mesh, "
                   "its curve, and a slider that moves the mesh")
      ->option_text("DIR");
  AddShape(*command, *options);
  command->add_option("--fit", options->fit, "find the weights of the clip for the components of this .npz instead")
      ->option_text("FILE");
  AddExpert(*command, *options);
  AddStrict(*command, options->strict);
  command->add_flag("--json", options->json, "print one JSON object");
  command->footer(
      "Examples:\n"
      "  sac components face.obj face.pc2 --positive -o face.npz -o face.glb -o face.csv\n"
      "  sac components dance.sac --domain gradient --count 20 -o dance.npz\n"
      "  sac components --fit face.npz other.obj other.pc2 -o other.npz\n");
  return {command, [options, command] { return CheckOptions(*command, *options); },
          [options] { return Run(*options); }};
}

}  // namespace sac

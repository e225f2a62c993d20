// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/distortion_report.h"
#include "cli/progress.h"
#include "files/clip_input.h"
#include "metrics/error_meter.h"

namespace sac {
namespace {

struct CompareOptions {
  std::vector<std::string> original, decoded;
  bool json = false;
};

Status Measure(const CompareOptions& options, ClipInput& original, DistortionMetrics& metrics) {
  std::unique_ptr<ClipInput> decoded;
  // Far coordinates are compared in double: both are relative to the same point.
  ClipInputSettings settings;
  settings.offset = original.offset();
  settings.segments = true;
  SAC_RETURN_IF_ERROR(ClipInput::Open(options.decoded, decoded, settings));
  const auto differ = [&](const char* what, std::size_t a, std::size_t b) {
    return Status::InvalidArgument(options.decoded.front() + ": " + std::to_string(b) + " " + what + ", but " +
                                   options.original.front() + " has " + std::to_string(a));
  };
  if (const std::size_t a = original.mesh().positions.size(), b = decoded->mesh().positions.size(); a != b) {
    return differ("vertices", a, b);
  }
  const std::uint32_t frames = *original.frame_count();
  if (decoded->frame_count() != frames) {
    return differ("frames", frames, *decoded->frame_count());
  }
  Progress progress(frames);
  ErrorMeter meter(original.mesh().triangles, original.mesh().positions.size());
  Positions a, b;
  for (std::uint32_t f = 0; f < frames; ++f) {
    bool ends = false, decoded_ends = false;
    SAC_RETURN_IF_ERROR(original.Next(a, ends));
    if (ends) {
      SAC_RETURN_IF_ERROR(original.NextSegment(ends));
      meter.BeginMesh(original.mesh().triangles, original.mesh().positions.size());
      SAC_RETURN_IF_ERROR(original.Next(a, ends));
    }
    SAC_RETURN_IF_ERROR(decoded->Next(b, decoded_ends));
    if (decoded_ends) {
      SAC_RETURN_IF_ERROR(decoded->NextSegment(decoded_ends));
      SAC_RETURN_IF_ERROR(decoded->Next(b, decoded_ends));
    }
    if (a.size() != b.size()) {
      return Status::InvalidArgument(decoded->name_of(f) + ": " + std::to_string(b.size()) + " vertices, but " +
                                     original.name_of(f) + " has " + std::to_string(a.size()));
    }
    meter.Add(a, b);
    progress.FramesDone(f + 1);
  }
  metrics = meter.Result();
  return Status::Ok();
}

Status Compare(const CompareOptions& options) {
  std::unique_ptr<ClipInput> original;
  ClipInputSettings settings;
  settings.segments = true;
  SAC_RETURN_IF_ERROR(ClipInput::Open(options.original, original, settings));
  const std::size_t vertices = original->mesh().positions.size();
  DistortionMetrics metrics;
  SAC_RETURN_IF_ERROR(Measure(options, *original, metrics));
  if (options.json) {
    Json json;
    AddDistortion(metrics, json);
    json["frames"] = metrics.frames;
    json["vertices"] = vertices;
    std::fputs(JsonLine(json).c_str(), stdout);
    return Status::Ok();
  }
  std::printf("%zu frames, %zu vertices\n", metrics.frames, vertices);
  PrintDistortion(metrics, stdout);
  return Status::Ok();
}

}  // namespace

Command AddCompareCommand(CLI::App& app) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "Measure how far one clip is from another.");
  command->add_option("ORIGINAL", options->original, "a clip as for encode; its triangles are used")
      ->required()
      ->option_text("...");
  command->add_option("--with", options->decoded, "a clip of as many frames and vertices, in the same order")
      ->required()
      ->option_text("DECODED...");
  command->add_flag("--json", options->json, "print one JSON object");
  command->footer(
      "KG is in percent, STED and its parts have no unit, the largest error is in model units.\n\n"
      "Example:\n"
      "  sac compare body.obj walk.pc2 --with decoded.obj decoded.pc2\n");
  return {command, [] { return Status::Ok(); }, [options] { return Compare(*options); }};
}

}  // namespace sac

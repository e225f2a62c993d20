// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/number_option.h"
#include "cli/progress.h"
#include "cli/warning_report.h"
#include "files/clip_output.h"
#include "synth/synth.h"

namespace sac {
namespace {

struct SynthOptions {
  std::string kind, output;
  SynthSettings settings;
  bool force = false;
};

Status CheckOptions(SynthOptions& options) {
  const auto* kind = std::find(kSynthKindNames.begin(), kSynthKindNames.end(), options.kind);
  options.settings.kind = static_cast<SynthKind>(kind - kSynthKindNames.begin());
  if (const std::uint32_t least = MinSynthVertices(options.settings.kind); options.settings.vertices < least) {
    return Status::InvalidArgument("--vertices: a " + options.kind + " has " + std::to_string(least) + " or more");
  }
  if (!ClipOutput::IsClipName(options.output)) {
    return Status::InvalidArgument(ClipOutput::NameError(options.output));
  }
  return Status::Ok();
}

Status Synthesize(const SynthOptions& options) {
  SynthClip clip;
  Progress progress(options.settings.frames);
  progress.Begin("shape");
  SAC_RETURN_IF_ERROR(SynthClip::Create(options.settings, clip));
  std::unique_ptr<ClipOutput> output;
  SAC_RETURN_IF_ERROR(
      ClipOutput::Open(options.output, clip.mesh(), {clip.rate().per_second(), clip.frames(), options.force}, output));
  for (std::uint32_t f = 0; f < clip.frames(); ++f) {
    SAC_RETURN_IF_ERROR(output->Write(f, clip.Frame(f)));
    progress.FramesDone(f + 1);
  }
  SAC_RETURN_IF_ERROR(TellWarnings(output->StaleFrames(), false));
  return output->Commit();
}

}  // namespace

Command AddSynthCommand(CLI::App& app) {
  auto options = std::make_shared<SynthOptions>();
  CLI::App* command = app.add_subcommand("synth", "Make a procedural clip, 30 frames a second, in metres.");
  command->add_option("KIND", options->kind, "walker, flag, sphere, parts or vase")
      ->required()
      ->check(CLI::IsMember(std::vector<std::string>(kSynthKindNames.begin(), kSynthKindNames.end())))
      ->option_text(" ");
  command->add_option("-o,--output", options->output, "clip.pc2, clip.mdd, clip.abc or a pattern, as for decode")
      ->required()
      ->option_text("OUT");
  command->add_flag("--force", options->force, "replace a mesh that is there beside the cache to write");
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
  AddNumber(*command, "--vertices", options->settings.vertices, 1u, kMaxSynthVertices,
            "about how many; the number that comes out is within 15 % from 500 on [5000]");
  AddNumber(*command, "--frames", options->settings.frames, 1u, kMost, "how many [100]");
  AddNumber(*command, "--seed", options->settings.seed, 0u, kMost, "varies proportions, phases and paths [1]");
  command->footer(
      "walker: an articulated figure; flag: cloth in the wind; sphere: rotating and pulsating; parts: many rigid\n"
      "pieces; vase: one rigid body. Equal options give equal clips.\n\n"
      "Example:\n"
      "  sac synth walker -o walker.pc2 --vertices 10000 --frames 200\n");
  return {command, [options] { return CheckOptions(*options); }, [options] { return Synthesize(*options); }};
}

}  // namespace sac

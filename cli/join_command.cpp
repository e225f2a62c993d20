// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/checked_stream.h"
#include "cli/commands.h"
#include "cli/distortion_report.h"
#include "cli/number_option.h"
#include "cli/progress.h"
#include "cli/spliced_input.h"
#include "files/overwriting.h"
#include "format/stream_splicer.h"

namespace sac {
namespace {

struct JoinOptions {
  std::vector<std::string> inputs;
  std::string output;
  SpliceSettings splice;
  bool check = true, json = false;
};

Status Join(const JoinOptions& options) {
  Progress progress;
  CheckedStream output(options.check, [&progress](std::uint32_t frames) { progress.FramesDone(frames); });
  SAC_RETURN_IF_ERROR(output.Open(options.output));
  StreamSplicer splicer(options.splice);
  for (const std::string& input : options.inputs) SAC_RETURN_IF_ERROR(SpliceInput(input, {}, splicer, output));
  SAC_RETURN_IF_ERROR(splicer.Finish());
  SAC_RETURN_IF_ERROR(output.Write(splicer.TakeBytes()));
  SAC_RETURN_IF_ERROR(output.Commit());
  if (splicer.dropped_metadata()) {
    std::fprintf(stderr, "warning: %s: has the metadata of %s; others say something else, which is left out\n",
                 options.output.c_str(), options.inputs.front().c_str());
  }
  std::FILE* const report = IsStandardOutput(options.output) ? stderr : stdout;
  if (options.json) {
    const Json json = {
        {"bytes", output.bytes()}, {"frames", splicer.frames_written()}, {"groups", splicer.groups_written()}};
    std::fputs(JsonLine(json).c_str(), report);
  } else {
    std::fprintf(report, "%s: %llu bytes, %u frames in %zu groups of %zu streams\n", options.output.c_str(),
                 static_cast<unsigned long long>(output.bytes()), splicer.frames_written(), splicer.groups_written(),
                 options.inputs.size());
  }
  return Status::Ok();
}

}  // namespace

Command AddJoinCommand(CLI::App& app) {
  auto options = std::make_shared<JoinOptions>();
  CLI::App* command = app.add_subcommand("join", "Put streams together to one, without decoding them.");
  command->add_option("STREAM", options->inputs, "the streams to read, in the order of time; - is standard input")
      ->required()
      ->option_text("...");
  command->add_option("-o,--output", options->output, "the stream to write; - is standard output")
      ->required()
      ->option_text("FILE");
  AddSplicing(*command, options->splice, options->check);
  command->add_flag("--renumber", options->splice.renumber,
                    "take streams of the same mesh as they are given, whatever number they say their first frame has");
  command->add_flag("--json", options->json, "print one line of JSON");
  command->footer(
      "A stream that has the start of the one before, as parts of one clip have, goes on with it; its first frame has "
      "to\n"
      "be the one after the last. Any other stream is a further segment, with a mesh of its own.\n\n"
      "Examples:\n"
      "  sac join part1.sac part2.sac part3.sac -o clip.sac\n"
      "  sac join walk.sac run.sac -o both.sac\n");
  return {command, [options] { return CheckOverwriting(options->inputs, {options->output}); },
          [options] { return Join(*options); }};
}

}  // namespace sac

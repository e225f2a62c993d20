// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/checked_stream.h"
#include "cli/commands.h"
#include "cli/distortion_report.h"
#include "cli/frame_range_option.h"
#include "cli/progress.h"
#include "cli/spliced_input.h"
#include "files/overwriting.h"
#include "format/stream_splicer.h"

namespace sac {
namespace {

struct CutOptions {
  std::string input, output;
  WantedFrames frames;
  SpliceSettings splice;
  bool check = true, json = false;
};

Status Cut(const CutOptions& options) {
  Progress progress;
  CheckedStream output(options.check, [&progress](std::uint32_t frames) { progress.FramesDone(frames); });
  SAC_RETURN_IF_ERROR(output.Open(options.output));
  StreamSplicer splicer(options.splice);
  FrameSpan wanted;
  wanted.begin = options.frames.begin;
  if (options.frames.end) wanted.end = *options.frames.end;
  SAC_RETURN_IF_ERROR(SpliceInput(options.input, wanted, splicer, output));
  const std::uint64_t all = splicer.frames();
  if (wanted.begin >= all || (options.frames.end && wanted.end > all)) {
    return Status::InvalidArgument(
        options.input + ": has " + std::to_string(all) + " frames, numbers from 0 on; " + std::to_string(wanted.begin) +
        ":" + (options.frames.end ? std::to_string(wanted.end) : std::string()) + " is not within them");
  }
  SAC_RETURN_IF_ERROR(splicer.Finish());
  SAC_RETURN_IF_ERROR(output.Write(splicer.TakeBytes()));
  SAC_RETURN_IF_ERROR(output.Commit());
  const FrameSpan& taken = splicer.taken();
  if (!options.frames.end) wanted.end = all;
  if (taken != wanted) {
    std::fprintf(stderr, "warning: %s: frames %llu:%llu were asked for, whole groups are %llu:%llu\n",
                 options.input.c_str(), static_cast<unsigned long long>(wanted.begin),
                 static_cast<unsigned long long>(wanted.end), static_cast<unsigned long long>(taken.begin),
                 static_cast<unsigned long long>(taken.end));
  }
  std::FILE* const report = IsStandardOutput(options.output) ? stderr : stdout;
  if (options.json) {
    const Json json = {{"bytes", output.bytes()},
                       {"first_frame", taken.begin},
                       {"frames", taken.size()},
                       {"groups", splicer.groups_written()}};
    std::fputs(JsonLine(json).c_str(), report);
  } else {
    std::fprintf(report, "%s: %llu bytes, frames %llu:%llu in %zu groups\n", options.output.c_str(),
                 static_cast<unsigned long long>(output.bytes()), static_cast<unsigned long long>(taken.begin),
                 static_cast<unsigned long long>(taken.end), splicer.groups_written());
  }
  return Status::Ok();
}

}  // namespace

Command AddCutCommand(CLI::App& app) {
  auto options = std::make_shared<CutOptions>();
  CLI::App* command = app.add_subcommand("cut", "Take a range of frames out of a stream, without decoding it.");
  command->add_option("STREAM", options->input, "the stream to read; - is standard input")
      ->required()
      ->option_text(" ");
  AddFrameRange(
      *command, "FRAMES", options->frames,
      "frames A up to but without B, from 0; A: to the end, :B from the first; whole groups are taken, from the "
      "last border of groups at A or before to the first at B or behind")
      ->required()
      ->option_text("A:B");
  command->add_option("-o,--output", options->output, "the stream to write; - is standard output")
      ->required()
      ->option_text("FILE");
  AddSplicing(*command, options->splice, options->check);
  command->add_flag("--json", options->json, "print one line of JSON");
  command->footer(
      "The frames are numbered from 0 again; the metadata say what number the first had, by which sac join finds its\n"
      "place. Groups are what --group of sac encode says, 128 frames by default.\n\n"
      "Example:\n"
      "  sac cut clip.sac 128:256 -o second.sac\n");
  return {command, [options] { return CheckOverwriting({options->input}, {options->output}); },
          [options] { return Cut(*options); }};
}

}  // namespace sac

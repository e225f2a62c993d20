// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/distortion_report.h"
#include "cli/number_option.h"
#include "files/output_file.h"
#include "files/overwriting.h"
#include "files/stream_input.h"
#include "format/thinning.h"

namespace sac {
namespace {

struct ThinOptions {
  std::string input, output;
  std::uint32_t layers = 1;
  bool json = false;
};

Status Thin(const ThinOptions& options) {
  StreamInput input;
  SAC_RETURN_IF_ERROR(input.Open(options.input));
  const auto at = [&input](const Status& s) { return Status(s.code(), input.name() + ": " + s.message()); };
  OutputFile output;
  SAC_RETURN_IF_ERROR(output.Open(options.output));
  StreamThinner thinner(options.layers);
  std::uint64_t before = 0, after = 0;
  for (std::span<const std::uint8_t> chunk;;) {
    SAC_RETURN_IF_ERROR(input.Read(chunk));
    if (chunk.empty()) break;
    before += chunk.size();
    std::vector<std::uint8_t> kept;
    if (const Status s = thinner.Take(chunk, kept); !s.ok()) return at(s);
    after += kept.size();
    SAC_RETURN_IF_ERROR(output.Write(kept.data(), kept.size()));
  }
  if (const Status s = thinner.Finish(); !s.ok()) return at(s);
  SAC_RETURN_IF_ERROR(output.Commit());
  if (thinner.layers_dropped() == 0) {
    std::fprintf(stderr, "warning: %s: no group has more than %u layers; the stream is copied as it is\n",
                 input.name().c_str(), options.layers);
  }
  const Json json = {{"bytes_before", before}, {"bytes", after}, {"layers_dropped", thinner.layers_dropped()}};
  std::FILE* const report = IsStandardOutput(options.output) ? stderr : stdout;
  if (options.json) {
    std::fputs(JsonLine(json).c_str(), report);
  } else {
    std::fprintf(report, "%s: %llu bytes, %llu before, %llu layers dropped\n", options.output.c_str(),
                 static_cast<unsigned long long>(after), static_cast<unsigned long long>(before),
                 static_cast<unsigned long long>(thinner.layers_dropped()));
  }
  return Status::Ok();
}

}  // namespace

Command AddThinCommand(CLI::App& app) {
  auto options = std::make_shared<ThinOptions>();
  CLI::App* command = app.add_subcommand("thin", "Drop layers of a stream without decoding it.");
  command->add_option("STREAM", options->input, "the stream to read; - is standard input")
      ->required()
      ->option_text(" ");
  command->add_option("-o,--output", options->output, "the stream to write; - is standard output")
      ->required()
      ->option_text("FILE");
  AddNumber(*command, "--layers", options->layers, 1u, 0xffffffffu, "layers of each group to keep")->required();
  command->add_flag("--json", options->json, "print one line of JSON");
  command->footer(
      "Streams have layers when they were encoded with --base-levels: first frames, coarse to fine in time, then "
      "detail.\n"
      "What is missing of a frame is what its neighbours say of it.\n\n"
      "Example:\n"
      "  sac thin clip.sac --layers 2 -o small.sac\n");
  return {command, [options] { return CheckOverwriting({options->input}, {options->output}); },
          [options] { return Thin(*options); }};
}

}  // namespace sac

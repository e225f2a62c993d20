// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "cli/commands.h"
#include "cli/program.h"
#include "sac/version.h"

namespace {

std::vector<sac::Command> AddCommands(CLI::App& app) {
  app.name("sac");
  app.description("Streaming codec for animated triangle meshes.");
  app.set_version_flag("--version", "sac " SAC_VERSION_STRING ", stream format " SAC_STREAM_VERSION_STRING);
  app.require_subcommand(1);
  app.footer(
      "sac COMMAND --help tells the options of a command.\n"
      "Exit codes: 0 success, 1 a file, a stream or the disk is at fault, 2 the command line is.\n\n"
      "Examples:\n"
      "  sac encode body.obj walk.pc2 -o walk.sac\n"
      "  sac info walk.sac\n"
      "  sac decode walk.sac -o frame_%04d.obj\n");
  return {sac::AddEncodeCommand(app), sac::AddDecodeCommand(app),  sac::AddInfoCommand(app),
          sac::AddVerifyCommand(app), sac::AddCompareCommand(app), sac::AddComponentsCommand(app),
          sac::AddPoseCommand(app),   sac::AddSynthCommand(app),   sac::AddSweepCommand(app),
          sac::AddThinCommand(app),   sac::AddCutCommand(app),     sac::AddJoinCommand(app),
          sac::AddPlayCommand(app),   sac::AddViewCommand(app),    sac::AddReferenceCommand(app)};
}

}  // namespace

int main(int argc, char** argv) { return sac::RunProgram(argc, argv, AddCommands); }

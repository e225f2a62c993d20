// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/program.h"

namespace sac {
namespace {

// Where an installation has the program, and where a build has it.
constexpr const char* kPlaces[] = {"../libexec/sac/sac-sweep", "../bench/sweep/sac-sweep", "sac-sweep"};

// Becomes the program sac-sweep.
Status RunSweepProgram(const std::vector<std::string>& arguments) {
  const std::string program = FindBesideProgram(kPlaces).string();
  if (program.empty()) {
    return Status::Unsupported(
        "sweep: the program sac-sweep is not installed beside sac; a build with -DSAC_BUILD_SWEEP=ON has it");
  }
  std::vector<std::string> words{program, "--sac", ThisProgram()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  return Status::IoError(program + ": " + std::strerror(errno));
}

}  // namespace

Command AddSweepCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("sweep", "Measure rate and distortion over a range of settings, beside peers.");
  // All of its words, --help too, are for the program.
  command->prefix_command();
  command->set_help_flag();
  return {command, [] { return Status::Ok(); }, [command] { return RunSweepProgram(command->remaining()); }};
}

}  // namespace sac

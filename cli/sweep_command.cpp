// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "cli/commands.h"
#include "cli/program.h"

namespace sac {
namespace {

namespace fs = std::filesystem;

// Where an installation has the program, and where a build has it.
constexpr const char* kPlaces[] = {"../libexec/sac/sac-sweep", "../bench/sweep/sac-sweep", "sac-sweep"};

// Becomes the program sac-sweep.
Status RunSweepProgram(const std::vector<std::string>& arguments) {
  const std::string sac = ThisProgram();
  for (const char* place : kPlaces) {
    const fs::path program = fs::path(sac).parent_path() / place;
    std::error_code error;
    if (!fs::is_regular_file(program, error)) continue;
    std::vector<std::string> words{program.string(), "--sac", sac};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    return Status::IoError(program.string() + ": " + std::strerror(errno));
  }
  return Status::Unsupported(
      "sweep: the program sac-sweep is not installed beside sac; a build with -DSAC_BUILD_SWEEP=ON has it");
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

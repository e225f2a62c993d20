// SPDX-License-Identifier: Apache-2.0
#include "cli/program.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include "files/temporary_files.h"

namespace sac {
namespace {

enum ExitCode { kOk = 0, kDataError = 1, kUsageError = 2 };

// A file must not become standard output, and be written to, because that was closed.
void OccupyStandardStreams() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // The lowest free number is taken; reading from or writing to it is an error as before.
    if (fcntl(fd, F_GETFD) < 0) (void)!open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

ExitCode Fail(ExitCode code, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::fflush(stdout);
  std::fprintf(stderr, "sac: %s\n", message.c_str());
  return code;
}

// Also of a report that did not fit on the disk.
ExitCode FlushOutput(ExitCode code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  return Fail(kDataError, std::string("standard output: ") + std::strerror(errno));
}

// CLI11 prints a description as it is; breaks the lines of those of options.
void WrapDescriptions(CLI::App& app) {
  constexpr std::size_t kColumns = 80;
  for (CLI::Option* option : app.get_options()) {
    std::istringstream words(option->get_description());
    std::string word, text;
    for (std::size_t column = 0; words >> word; column += word.size() + 1) {
      if (!text.empty()) text += column + word.size() > kColumns ? '\n' : ' ';
      if (column + word.size() > kColumns) column = 0;
      text += word;
    }
    option->description(text);
  }
}

ExitCode Run(int argc, char** argv, const std::function<std::vector<Command>(CLI::App&)>& add_commands) {
  CLI::App app;
  const std::vector<Command> commands = add_commands(app);
  for (CLI::App* command : app.get_subcommands(nullptr)) WrapDescriptions(*command);
  WrapDescriptions(app);
  const auto chosen = [&] {
    return std::find_if(commands.begin(), commands.end(), [](const Command& c) { return c.app->parsed(); });
  };
  const auto usage_error = [&](const std::string& message) {
    const bool sub = chosen() != commands.end() && chosen()->app != &app;
    const std::string name = app.get_name() + (sub ? " " + chosen()->app->get_name() : "");
    return Fail(kUsageError, message + " (see " + name + " --help)");
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    app.exit(request);
    std::cout.flush();
    return kOk;
  } catch (const CLI::ParseError& error) {
    return usage_error(error.what());
  }
  if (const Status status = chosen()->check(); !status.ok()) return usage_error(status.message());
  const Status status = chosen()->run();
  return status.ok() ? kOk : Fail(kDataError, status.message());
}

}  // namespace

int RunProgram(int argc, char** argv, const std::function<std::vector<Command>(CLI::App&)>& add_commands) {
  // A write that cannot be done then fails, and is reported.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  OccupyStandardStreams();
  try {
    RemoveTemporaryFilesOnSignals();
    return FlushOutput(Run(argc, argv, add_commands));
  } catch (const std::bad_alloc&) {
    return Fail(kDataError, "not enough memory");
  } catch (const std::exception& error) {
    return Fail(kDataError, error.what());
  }
}

std::string ThisProgram() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).string();
}

std::filesystem::path FindBesideProgram(std::span<const char* const> places) {
  const std::filesystem::path folder = std::filesystem::path(ThisProgram()).parent_path();
  for (const char* place : places) {
    std::error_code error;
    if (std::filesystem::is_regular_file(folder / place, error)) return folder / place;
  }
  return {};
}

}  // namespace sac

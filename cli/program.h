// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cli/commands.h"

namespace sac {

// The body of a main(): options, exit codes (0 success, 1 a file, a stream or the disk is at fault, 2 the command line
// is), messages of one line on standard error, signals, temporary files. `add_commands` names the program in `app`,
// adds its options and returns its commands, of which the command line chooses one; a program without subcommands is a
// command itself.
int RunProgram(int argc, char** argv, const std::function<std::vector<Command>(CLI::App& app)>& add_commands);

// The path of the program that is running; empty when the system does not tell.
std::string ThisProgram();

// The first of `places`, paths from the folder of the program, that is a file; empty when none is.
std::filesystem::path FindBesideProgram(std::span<const char* const> places);

}  // namespace sac

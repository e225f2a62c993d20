// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "sac/status.h"

namespace sac {

// A command of the program, with the options it has added to `app`.
struct Command {
  const CLI::App* app;
  std::function<Status()> check;  // of the options, before any file is written; a failure is a usage error
  std::function<Status()> run;
};

Command AddEncodeCommand(CLI::App& app);
Command AddDecodeCommand(CLI::App& app);
Command AddInfoCommand(CLI::App& app);
Command AddVerifyCommand(CLI::App& app);
Command AddCompareCommand(CLI::App& app);
Command AddComponentsCommand(CLI::App& app);
Command AddPoseCommand(CLI::App& app);
Command AddSynthCommand(CLI::App& app);
Command AddPlayCommand(CLI::App& app);
Command AddSweepCommand(CLI::App& app);
Command AddViewCommand(CLI::App& app);
Command AddThinCommand(CLI::App& app);
Command AddCutCommand(CLI::App& app);
Command AddJoinCommand(CLI::App& app);
Command AddReferenceCommand(CLI::App& app);

}  // namespace sac

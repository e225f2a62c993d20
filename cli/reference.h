// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace sac {

// The manual page of `app` itself or, if `command` is not null, of one of its commands, in the roff of man(7), section
// 1. `version` stands in its foot.
std::string ManPage(const CLI::App& app, const CLI::App* command, const std::string& version);

// A completion of commands, options, their choices and file names, for bash and for zsh.
std::string BashCompletion(const CLI::App& app);
std::string ZshCompletion(const CLI::App& app);

}  // namespace sac

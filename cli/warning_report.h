// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "files/warnings.h"
#include "sac/status.h"

namespace sac {

// Adds the flag --strict.
void AddStrict(CLI::App& app, bool& strict);

// Prints each warning as a line on standard error. With `strict` nothing is printed: the first of them becomes a
// failure.
Status TellWarnings(const Warnings& warnings, bool strict);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <initializer_list>
#include <string>

namespace sac {

// The first of `names` that the command line has; empty where it has none of them.
inline std::string FirstGiven(const CLI::App& command, std::initializer_list<const char*> names) {
  const auto* const given =
      std::find_if(names.begin(), names.end(), [&command](const char* name) { return command.count(name) > 0; });
  return given == names.end() ? std::string() : *given;
}

}  // namespace sac

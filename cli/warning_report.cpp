// SPDX-License-Identifier: Apache-2.0
#include "cli/warning_report.h"

#include <cstdio>
#include <string>

namespace sac {

void AddStrict(CLI::App& app, bool& strict) {
  app.add_flag("--strict", strict, "fail, and write nothing, where there would be a warning");
}

Status TellWarnings(const Warnings& warnings, bool strict) {
  if (strict && !warnings.empty()) {
    const std::size_t more = warnings.size() - 1;
    return Status::InvalidArgument(warnings.front() + (more > 0 ? " (and " + std::to_string(more) + " more)" : "") +
                                   " [--strict]");
  }
  for (const std::string& warning : warnings) std::fprintf(stderr, "sac: warning: %s\n", warning.c_str());
  return Status::Ok();
}

}  // namespace sac

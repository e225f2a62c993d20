// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sac/status.h"

namespace sac {

// What a program took, from its start to its end.
struct ProcessUsage {
  double seconds = 0;      // by the clock
  double cpu_seconds = 0;  // user and system, all threads
  double peak_mb = 0;      // resident memory, at least what this process holds: see ForgetPeakMemory
};

// Runs `command` (a path and its arguments) to its end, without standard input, and gives its standard output. It is
// killed when this process ends. kInvalidArgument with the last line of its standard error when it fails, kIoError when
// it cannot be run. May be called from several threads.
Status RunProcess(const std::vector<std::string>& command, ProcessUsage& usage, std::string& output);

// The system counts the peak of a process from before it becomes another program, as a copy of this one. Gives unused
// memory back and starts that count anew, so that it is a few megabytes.
void ForgetPeakMemory();

}  // namespace sac

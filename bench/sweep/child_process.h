// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sac/status.h"

namespace sac {

// The resources that a program used from its start to its end.
struct ProcessUsage {
  double seconds = 0;      // wall-clock time
  double cpu_seconds = 0;  // user and system time of all threads
  double peak_mb = 0;      // peak resident memory; at least that of this process, see ForgetPeakMemory()
};

// Runs `command` (a path and its arguments) to its end, without standard input, and gives its standard output. The
// program is killed when this process ends. Returns kInvalidArgument with the last line of the program's standard error
// when it fails, kIoError when it cannot be run. May be called from several threads.
Status RunProcess(const std::vector<std::string>& command, ProcessUsage& usage, std::string& output);

// Gives unused memory back to the system and resets this process's peak. A child process begins as a copy of this one,
// and the system counts that copy in the peak of the program that the child becomes.
void ForgetPeakMemory();

}  // namespace sac

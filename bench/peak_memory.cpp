// SPDX-License-Identifier: Apache-2.0
#include "bench/peak_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace sac::bench {
namespace {

// The value of the line `name` of /proc/self/status in megabytes. The file counts in kB.
double StatusMegabytes(const std::string& name) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(name)) return std::stod(line.substr(name.size())) / 1000;
  }
  return 0;
}

}  // namespace

void PeakMemory::Start() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;
  before_ = StatusMegabytes("VmRSS:");
}

double PeakMemory::Megabytes() const { return StatusMegabytes("VmHWM:") - before_; }

}  // namespace sac::bench

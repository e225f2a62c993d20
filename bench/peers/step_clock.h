// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

namespace sac::bench {

// Measures the CPU seconds of the process, all threads together, by step. Steps are listed in the order of their first
// lap.
class StepClock {
 public:
  // Adds the time since the last call, or since the clock was made, to `step`.
  void Lap(const char* step) {
    const double now = Now(), spent = now - last_;
    last_ = now;
    const auto known = std::find_if(seconds_.begin(), seconds_.end(), [&](const auto& s) { return s.first == step; });
    if (known == seconds_.end()) {
      seconds_.emplace_back(step, spent);
    } else {
      known->second += spent;
    }
  }
  const std::vector<std::pair<std::string, double>>& seconds() const { return seconds_; }

 private:
  static double Now() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }

  double last_ = Now();
  std::vector<std::pair<std::string, double>> seconds_;
};

}  // namespace sac::bench

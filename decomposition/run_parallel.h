// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace sac {

// Runs jobs 0 to `jobs` - 1 on up to `threads` threads, the caller's included; 0: as many as the machine has. Which
// thread runs a job is left to chance, so a result may depend on the number of a job alone. The first exception that a
// job throws is thrown again when all jobs have ended.
void RunParallel(std::size_t jobs, std::uint32_t threads, const std::function<void(std::size_t job)>& job);

}  // namespace sac

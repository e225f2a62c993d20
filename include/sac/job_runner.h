// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace sac {

// Runs jobs 0 to `jobs` - 1: calls `job` once with each number, in any order and on any threads, and returns when all
// calls have returned. `job` throws nothing.
using JobRunner = std::function<void(std::size_t jobs, const std::function<void(std::size_t)>& job)>;

}  // namespace sac

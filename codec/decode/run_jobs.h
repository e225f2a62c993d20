// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

// Whether there are threads; without them all jobs run on the caller's.
#if defined(__wasi__) && !defined(_REENTRANT)
#define SAC_HAS_THREADS 0
#else
#define SAC_HAS_THREADS 1
#endif

namespace sac {

// Runs jobs 0 to `jobs` - 1 by calling `job`, which throws nothing, with each number, and returns when all are done.
// The first runs on the caller's thread, each other on a thread that lives as long as the call, or on the caller's when
// there are no threads or too many already.
void RunOnThreads(std::size_t jobs, const std::function<void(std::size_t)>& job);

}  // namespace sac

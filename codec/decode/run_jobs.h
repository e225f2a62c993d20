// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

// Whether the platform has threads. Without them all jobs run on the caller's thread.
#if defined(__wasi__) && !defined(_REENTRANT)
#define SAC_HAS_THREADS 0
#else
#define SAC_HAS_THREADS 1
#endif

namespace sac {

// Runs jobs 0 to `jobs` - 1: calls `job`, which must throw nothing, with each number, and returns when all calls have
// returned. It is what DecoderSettings::run_jobs replaces. Job 0 runs on the caller's thread and every other job on a
// thread that lives as long as the call, or on the caller's when the platform has no threads or no thread can be
// started.
void RunOnThreads(std::size_t jobs, const std::function<void(std::size_t)>& job);

}  // namespace sac

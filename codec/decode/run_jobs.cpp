// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/run_jobs.h"

#if SAC_HAS_THREADS
#include <exception>
#include <thread>
#include <vector>
#endif

namespace sac {

#if SAC_HAS_THREADS

void RunOnThreads(std::size_t jobs, const std::function<void(std::size_t)>& job) {
  std::vector<std::thread> others;
  if (jobs > 1) others.reserve(jobs - 1);
  for (std::size_t i = 1; i < jobs; ++i) {
    try {
      others.emplace_back([&job, i] { job(i); });
    } catch (const std::exception&) {  // std::system_error or std::bad_alloc: no thread can be started
      job(i);
    }
  }
  if (jobs > 0) job(0);
  for (std::thread& other : others) other.join();
}

#else

void RunOnThreads(std::size_t jobs, const std::function<void(std::size_t)>& job) {
  for (std::size_t i = 0; i < jobs; ++i) job(i);
}

#endif

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "decomposition/run_parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace sac {

void RunParallel(std::size_t jobs, std::uint32_t threads, const std::function<void(std::size_t job)>& job) {
  const std::size_t wanted = threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failing;
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs; i = next++) {
      try {
        job(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(failing);
        if (!failure) failure = std::current_exception();
        next = jobs;
      }
    }
  };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < std::min(wanted, jobs); ++i) {
    try {
      others.emplace_back(work);
    } catch (const std::system_error&) {  // no thread can be started; those that run do its jobs
      break;
    }
  }
  work();
  for (std::thread& other : others) other.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace sac

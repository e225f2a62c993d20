// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>

namespace sac {

// Of every allocation in the program: operator new everywhere, malloc in what is linked statically, Eigen's too.
struct CountedMemory {
  std::atomic<long> until_failure = -1;  // allocations that still succeed; none fails while negative
  std::atomic<bool> fail_on = false;     // and all after the first failure
  std::atomic<long> allocations = 0;     // so far
  std::atomic<long> living = 0;
  std::atomic<std::size_t> bytes = 0;  // of the living
  std::atomic<std::size_t> peak_bytes = 0;
};

extern CountedMemory counted_memory;

}  // namespace sac

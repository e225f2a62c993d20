// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace sac {

// Of every allocation in the program: operator new everywhere, malloc in what is linked statically, Eigen's too.
struct CountedMemory {
  long until_failure = -1;  // allocations that still succeed; none fails while negative
  bool fail_on = false;     // and all after the first failure
  long allocations = 0;     // so far
  long living = 0;
  std::size_t bytes = 0;  // of the living
  std::size_t peak_bytes = 0;
};

extern CountedMemory counted_memory;

}  // namespace sac

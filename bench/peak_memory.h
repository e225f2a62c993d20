// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sac::bench {

// Measures how much the resident memory of the process has grown at its peak since Start(). It reads the kernel's
// high-water mark, of which a Linux process has only one; Start() resets it.
class PeakMemory {
 public:
  void Start();
  // The growth in megabytes.
  double Megabytes() const;

 private:
  double before_ = 0;
};

}  // namespace sac::bench

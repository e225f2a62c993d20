// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace sac::bench {

// What the process came to hold since Start() beyond what it held then, by the kernel's count of resident pages. Linux
// keeps one high-water mark (getrusage's ru_maxrss), which Start() resets.
class PeakMemory {
 public:
  void Start();
  double Megabytes() const;

 private:
  double before_ = 0;
};

}  // namespace sac::bench

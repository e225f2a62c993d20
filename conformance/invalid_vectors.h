// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "conformance/stream_parts.h"

namespace sac {

struct InvalidVector {
  std::string rule;  // of spec.md 11
  std::string name;
  std::string status;  // "corrupt", "unsupported" or "limit"
  Bytes stream;
};

// Streams that each break one rule.
std::vector<InvalidVector> InvalidVectors();

}  // namespace sac

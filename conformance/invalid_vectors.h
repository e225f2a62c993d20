// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "conformance/stream_parts.h"

namespace sac {

struct InvalidVector {
  std::string rule;  // the rule of spec.md 11 that the stream breaks
  std::string name;
  std::string status;  // "corrupt", "unsupported" or "limit"
  Bytes stream;
};

// All malformed streams. Each breaks one rule.
std::vector<InvalidVector> InvalidVectors();

}  // namespace sac

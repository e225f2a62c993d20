// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "conformance/stream_parts.h"

namespace sac {

struct ValidVector {
  std::string name;
  std::string covers;
  Bytes stream;
};

std::vector<ValidVector> ValidVectors();

}  // namespace sac

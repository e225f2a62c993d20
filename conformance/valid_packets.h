// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "conformance/valid_vectors.h"

namespace sac {

// Adds streams that show how packets follow each other, and what they may hold beside frames.
void AddPacketVectors(std::vector<ValidVector>& vectors);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <vector>

#include "format/packet.h"

namespace sac {

// Takes the header and the I-frame of `packets` apart, changes some of their elements, and writes them again with the
// fingerprint of the basis that comes of it, and groups of random residuals for it. False, and nothing changed, when
// they cannot be parsed or lead to no basis.
bool Resynthesize(std::vector<Packet>& packets, std::mt19937& random);

}  // namespace sac

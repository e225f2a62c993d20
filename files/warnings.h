// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace sac {

// What a file holds and cannot be kept, or what its user should know: a line each, which starts with the path.
using Warnings = std::vector<std::string>;

}  // namespace sac

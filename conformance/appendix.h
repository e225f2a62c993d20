// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace sac {

// Writes the bytes and the decoded positions of SmallStream() into the examples of spec.md, appendix A. Returns false
// when the file or the examples are missing.
bool UpdateAppendix(const std::filesystem::path& spec);

}  // namespace sac

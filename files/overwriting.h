// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sac/status.h"

namespace sac {

// The files of a clip, as named for ClipInput: a pattern stands for those that exist.
std::vector<std::string> FilesOfInput(const std::vector<std::string>& arguments);

// The files of a clip, as named for ClipOutput: a cache has a mesh beside it, a vertex animation texture its textures,
// `exr` or PNG.
std::vector<std::string> FilesOfOutput(const std::string& path, bool exr = false);

// kInvalidArgument if one of `outputs` is one of `inputs`, or two outputs are one, by whatever names and links. Devices
// and pipes may be shared; `-`, once each for input and output, is no file.
Status CheckOverwriting(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

// kInvalidArgument if there is a file at `path`, which the user did not name, that holds anything else than `bytes`.
Status CheckUnnamed(const std::string& path, const std::string& bytes);

// True if what is written to `path` comes out where standard output does.
bool IsStandardOutput(const std::string& path);

}  // namespace sac

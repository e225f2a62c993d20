// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sac/clip.h"
#include "sac/status.h"

namespace sac {

struct PosedOutput {
  std::string path;
  std::array<double, 3> offset = {};  // is added to positions, model units
  double quality = 50;                // of a stream
  bool force = false;                 // replace the mesh beside a cache
  bool strict = false;                // fail where there is a warning
};

// kInvalidArgument where the name is neither that of a clip nor of a stream; with `single` it may be a mesh's.
Status CheckPosedOutput(const std::string& path, bool single);

// The files that are written.
std::vector<std::string> FilesOfPosed(const std::string& path);

// Writes a clip as files, or encodes it into a stream.
Status WritePosed(ClipReader& clip, const PosedOutput& output);

}  // namespace sac

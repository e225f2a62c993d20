// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/sweep/display_mesh.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// A clip in the form that all codecs of a sweep get: triangles and positions, without attributes, as an OBJ file and a
// PC2 file.
struct SweepClip {
  std::string name;  // name of the input, without directory and extension
  std::string key;   // key of the clip's content
  std::string mesh_path, cache_path;
  std::uint32_t frames = 0;
  std::size_t vertices = 0, triangles = 0;
  double diagonal = 0;  // diagonal of the first frame's bounding box, model units
  DisplayMesh display;
};

// Divides the inputs of a command line into clips. A clip is a mesh followed by a cache, a pattern of file names, or a
// run of other meshes.
std::vector<std::vector<std::string>> ClipsOf(const std::vector<std::string>& inputs);

// Reads a clip and writes its two files into `directory`, named by its key. Errors name the file at fault.
Status PrepareClip(const std::vector<std::string>& inputs, const std::string& directory, SweepClip& clip);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/sweep/display_mesh.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// A clip as all codecs of a sweep get it: triangles and positions, without attributes, as an OBJ and a PC2 file.
struct SweepClip {
  std::string name;  // of the input, without directory and extension
  std::string key;   // of its content
  std::string mesh_path, cache_path;
  std::uint32_t frames = 0;
  std::size_t vertices = 0, triangles = 0;
  double diagonal = 0;  // of the first frame's bounding box, model units
  DisplayMesh display;
};

// Divides a command line's inputs into clips: a mesh followed by a cache, a pattern, or a run of other meshes.
std::vector<std::vector<std::string>> ClipsOf(const std::vector<std::string>& inputs);

// Reads a clip and writes its two files in `directory`, named by its key. Errors name the file.
Status PrepareClip(const std::vector<std::string>& inputs, const std::string& directory, SweepClip& clip);

}  // namespace sac

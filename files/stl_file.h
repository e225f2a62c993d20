// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "files/polygon_mesh.h"
#include "sac/status.h"

namespace sac {

// Parses the bytes of a binary or ASCII STL file; each triangle has three vertices of its own. Not OpenMesh's reader
// because that drops degenerate triangles, takes a truncated binary file for an ASCII file without triangles, welds a
// NaN to whatever vertex its map meets, reads numbers it cannot parse as the previous ones, and takes a solid named
// "outer" for a triangle. Messages do not name the file. `bytes` of an ASCII file become normalized text.
Status ParseStl(std::string& bytes, PolygonMesh& parsed);

}  // namespace sac

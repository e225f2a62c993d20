// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Parses the bytes of a binary or ASCII STL file. Corners at equal positions become one vertex, as in OpenMesh, in the
// order of first use. Not OpenMesh's reader because that drops degenerate triangles, takes a truncated binary file for
// an ASCII file without triangles, welds a NaN to whatever vertex its map meets, reads numbers it cannot parse as the
// previous ones, and takes a solid named "outer" for a triangle. Messages do not name the file.
Status ParseStl(std::string_view bytes, Mesh& mesh);

}  // namespace sac

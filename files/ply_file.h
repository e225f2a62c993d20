// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "files/polygon_mesh.h"
#include "sac/status.h"

namespace sac {

// Parses the bytes of a PLY file, ASCII or binary of either byte order, with properties of every type of the format.
// Kept of a vertex are x, y, z; nx, ny, nz; red, green, blue, alpha (or diffuse_red..., or r, g, b, a); texture
// coordinates as s, t, or u, v, or texture_u, texture_v. Kept of a face are the list vertex_indices or vertex_index and
// MeshLab's list texcoord, u and v of each corner. The rest is told as lost. Messages do not name the file. `bytes` of
// an ASCII file become normalized text.
Status ParsePly(std::string& bytes, PolygonMesh& parsed);

}  // namespace sac

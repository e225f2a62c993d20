// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "files/mesh_file.h"

namespace sac {

// True if the vertices of `frame`, a frame of a cache, are likely to be in another order than those of the mesh file's
// `mesh`: then the ends of an edge lie anywhere, and the median edge is many times as long. Lengths are relative to the
// median distance of vertices from their middle, so that units and poses do not matter. False where it cannot be told:
// for few edges, or positions that are not finite or all at one place. The frame has as many vertices as the mesh.
bool IsLikelyInAnotherOrder(const Mesh& mesh, const Positions& frame);

}  // namespace sac

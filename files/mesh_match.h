// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "files/vertex_order.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// How far the vertices of two meshes that were matched are apart, model units.
struct MatchDistance {
  double mean = 0, largest = 0;
};

// Finds which vertex of `author` each vertex of `decoded` is, so that the triangles of the one are those of the other,
// in whatever order and rotation, facing the same side. Colors of vertices that are refined by their neighbors'
// (Weisfeiler and Leman 1968) find the places that are alike; from a pair of triangles the match spreads over edges.
// Where the triangles leave a choice, as in symmetric meshes, equal parts and vertices without triangles, the positions
// decide: they need to be about the same, as decoded ones are.
//
// Both have positions and triangles with indices in range. kInvalidArgument: other numbers, or other triangles. Time
// grows as that of a sort.
Status MatchVertices(const Mesh& decoded, const Mesh& author, VertexOrder& order, MatchDistance& distance);

}  // namespace sac

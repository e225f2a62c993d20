#pragma once

#include <vector>

#include "sac/mesh.h"

namespace sac {

// The normals of the vertices: means of the normals of the triangles around a vertex, weighted by area, of length 1.
// The normal of a vertex without area around it is zero.
std::vector<Vec3f> VertexNormals(const Positions& positions, const std::vector<Triangle>& triangles);

}  // namespace sac

#pragma once

#include <vector>

#include "sac/mesh.h"

namespace sac {

// Area-weighted vertex normals of length 1; zero where a vertex has no area around it.
std::vector<Vec3f> VertexNormals(const Positions& positions, const std::vector<Triangle>& triangles);

}  // namespace sac

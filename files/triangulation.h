// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "files/faces.h"

namespace sac {

struct Triangulation {
  std::vector<Triangle> corners;  // indices of Faces::vertices, the triangles of a face one after the other
  std::size_t quads = 0;          // faces of four vertices
  std::size_t polygons = 0;       // faces of more
  std::size_t fragments = 0;      // faces of fewer than three, which have no triangles
  std::size_t overlapping = 0;    // faces whose fan has a flipped triangle, yet nothing better is found
};

// The normal of a face (Newell's), as long as twice its area. Exact for a face that is far from the origin, too: it is
// of the differences to the face's first vertex.
Vec3d NewellNormal(const Faces& faces, std::size_t face, const std::vector<Vec3d>& positions);

// Cuts faces into triangles without new vertices. A face (i0, i1, ...) becomes the fan (i0, ik, ik+1) where no triangle
// of that is flipped against the face's normal, as in every convex face. Other faces are cut by the
// tessellator of GLU in the plane of that normal; where it wants vertices that there are not, because edges cross, they
// remain fans. `positions` that faces need may be NaN.
Triangulation Triangulate(const Faces& faces, const std::vector<Vec3d>& positions);

}  // namespace sac

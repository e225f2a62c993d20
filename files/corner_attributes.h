// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "files/polygon_mesh.h"

namespace sac {

// Attributes of faces' corners as those of the triangles that were cut of the faces: corners[j][k] is the index, among
// the corners of parsed.faces, of corner k of triangle j, and mesh.triangles are the vertices. What a corner lacks is
// made up and told in parsed.losses or parsed.warnings.

// Fills mesh.uvs, each value once, and mesh.uv_triangles. Corners without texture coordinates get (0, 0).
void FinishUvs(PolygonMesh& parsed, const std::vector<Triangle>& corners, Mesh& mesh);

// Fills mesh.normals and, where corners of a vertex differ, mesh.normal_triangles. Corners without a normal get that of
// their face, among others that have one.
void FinishNormals(PolygonMesh& parsed, const std::vector<Triangle>& corners, Mesh& mesh);

}  // namespace sac

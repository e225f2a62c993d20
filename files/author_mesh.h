// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "files/mesh_file.h"
#include "files/obj_template.h"
#include "files/vertex_order.h"
#include "files/warnings.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// The mesh that a clip was made from, as its author has it, found again in the decoded one.
struct AuthorMesh {
  MeshFile file;
  std::optional<ObjTemplate> obj;  // of an OBJ file
  VertexOrder order;               // for each decoded vertex the author's
  // What a user should know: positions that are far apart.
  Warnings warnings;
};

// Reads the mesh file at `path` and matches it to the first frame of a clip, whose positions are relative to `offset`,
// so far as it was decoded (MatchVertices). kInvalidArgument: not the mesh of the clip. Messages start with the path.
Status OpenAuthorMesh(const std::string& path, const Mesh& decoded, const std::array<double, 3>& offset,
                      AuthorMesh& author);

}  // namespace sac

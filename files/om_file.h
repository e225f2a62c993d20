// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "files/polygon_mesh.h"
#include "sac/status.h"

namespace sac {

// Parses the bytes of an OM file, OpenMesh's own format, with OpenMesh. Messages do not name the file.
Status ParseOm(std::string_view bytes, PolygonMesh& parsed);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "files/polygon_mesh.h"
#include "sac/status.h"

namespace sac {

// Parses the text of an OFF file, normalized (NormalizeText): OFF with the prefixes ST, C and N for texture
// coordinates, colours and normals of vertices, which a row has in the order position, normal, colour (three or four
// numbers up to 1 with a point, or up to 255 without), texture coordinates. Colours of faces are counted as losses.
// kUnsupported for binary OFF and other dimensions. Messages are of the form "line 12: ..." and do not name the file.
Status ParseOff(std::string_view text, PolygonMesh& parsed);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "sac/status.h"

namespace sac {

// What stands between a file and OpenMesh 9's readers: they trust what they read, and abort, run away or misread bytes
// when it is not what they expect. These functions check the parts that the readers do not and rewrite the file as the
// readers want it; they do not parse the mesh. Messages do not name the file.

// PLY. The reader loses its place when a comment or a trailing blank precedes end_header, when an element other than
// the faces has lists, or when a type is one it does not know; it loops as often as the header says, and for ever
// without end_header. `has_lists` tells whether faces or vertices have lists beside the vertex indices: OpenMesh then
// has to read with Options::Custom.
Status CleanPly(std::string_view bytes, std::string& cleaned, bool& has_lists);

// OFF. The reader does not know comments, and counts the blanks of a line to tell what a vertex has. Binary OFF passes
// unchanged.
Status CleanOff(std::string_view bytes, std::string& cleaned);

// OM. The reader asserts on chunk types it does not expect, and resizes to whatever a custom property says. Keeps the
// chunks that make a Mesh (positions, normals, texture coordinates, colours, topology), each checked against the size
// of the file.
Status CleanOm(std::string_view bytes, std::string& cleaned);

}  // namespace sac

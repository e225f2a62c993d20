// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "files/warnings.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Mesh files, by the extension of their name in any case: read .obj, .ply, .off, .stl and .om; written .obj, .ply
// (binary, little endian) and .off. Every message starts with the path.

bool IsReadableMeshName(const std::string& path);
bool IsWritableMeshName(const std::string& path);

// Reads a mesh with its vertices and faces in the order of the file, none added, dropped or merged (but STL has no
// vertices of its own: equal positions become one). Polygons become fans (i0, ik, ik+1); faces of fewer than three
// vertices vanish. Positions are the nearest float32 and may be NaN or infinite. Texture coordinates that several
// corners share are stored once. On success there is a vertex, every index is in range, and normals and colors are
// empty or one per vertex.
// kIoError: not there, not readable; kInvalidArgument: not a mesh file by its name, or empty; kCorrupt and
// kUnsupported: its content.
Status ReadMesh(const std::string& path, Mesh& mesh);

// The bytes of a file named `path`; nothing is written. The mesh must be consistent: indices in range, attributes empty
// or complete. Positions come back from ReadMesh as the identical float32. Colours are carried by all three formats,
// texture coordinates and normals of corners only by OBJ: PLY and OFF have one of each per vertex, and are written
// without any if a vertex needs two, without normals with a warning.
//
// `offset` is added to the positions, model units. Where it is not zero all three formats hold the sum in double
// precision, PLY as properties of type double.
Status FormatMesh(const std::string& path, const Mesh& mesh, const std::array<double, 3>& offset, std::string& bytes,
                  Warnings& warnings);

// Writes a mesh file, whole or not at all, without an offset. Normals that it cannot hold are left out, as FormatMesh()
// says.
Status WriteMesh(const std::string& path, const Mesh& mesh);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "files/faces.h"
#include "files/warnings.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Mesh files, by the extension of their name in any case: read .obj, .ply, .off, .stl and .om; written .obj, .ply
// (binary, little endian) and .off. Every message starts with the path.

bool IsReadableMeshName(const std::string& path);
bool IsWritableMeshName(const std::string& path);

// What a mesh file holds. Vertices and faces are in the order of the file, none added, dropped or merged (but STL has
// no vertices of its own: corners at equal positions become one).
struct MeshFile {
  // Polygons are triangulated, faces of fewer than three vertices vanish. Positions are the nearest float32 and may be
  // NaN or infinite. There is a vertex, every index is in range, and attributes are empty or complete. Texture
  // coordinates that several corners share are stored once; normals are per vertex unless corners of a vertex differ,
  // then an entry serves the corners of one vertex that have that value.
  Mesh mesh;
  Faces faces;
  // The corners of each triangle, as indices of faces.vertices: corners[j][k] belongs to mesh.triangles[j][k].
  std::vector<Triangle> corners;
  // Positions as the file has them; empty where it has them in float32, and mesh.positions are all there is.
  std::vector<Vec3d> exact;
  // Where the first coordinate that is NaN or infinite stands ("line 7, vertex 2"); empty if all are finite.
  std::string not_finite;
  // What the file holds beyond this, and what is likely to be a mistake in it.
  Warnings warnings;
};

struct ReadSettings {
  // The first file of a sequence: where the faces are the same, its triangles are taken, so that they stay the same as
  // polygons move.
  const MeshFile* first = nullptr;
  bool weld = true;  // false: each triangle of an STL file has three vertices of its own
};

// Reads a mesh file. kIoError: not there, not readable; kInvalidArgument: not a mesh file by its name, or empty;
// kCorrupt and kUnsupported: its content.
Status ReadMeshFile(const std::string& path, const ReadSettings& settings, MeshFile& file);

// The bytes of a file. kIoError; kInvalidArgument for an empty one. Messages do not name the file.
Status ReadFileBytes(const std::string& path, std::string& bytes);

// The mesh of ReadMeshFile alone.
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

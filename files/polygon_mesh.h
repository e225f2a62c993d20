// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "files/faces.h"
#include "files/losses.h"
#include "files/mesh_file.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// What a parser makes of the bytes of a mesh file, before faces become triangles.
struct PolygonMesh {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::vector<Vec3d> positions;
  bool wide = false;       // positions may hold more than float32 does
  std::string not_finite;  // as MeshFile::not_finite

  Faces faces;  // indices are in range

  // Texture coordinates of corners: corner_uvs is empty or has an index of uvs, or kNone, for each corner of `faces`.
  std::vector<std::array<float, 2>> uvs;
  std::vector<std::uint32_t> corner_uvs;

  // Normals: one per vertex where corner_normals is empty, else as texture coordinates.
  std::vector<Vec3f> normals;
  std::vector<std::uint32_t> corner_normals;

  std::vector<std::array<std::uint8_t, 4>> colors;  // RGBA, one per vertex, or empty

  std::uint64_t objects = 0;  // that the file has one after the other, where it says so
  Losses losses;
  Warnings warnings;  // each without the path

  // Appends a vertex. `where` names it for messages ("line 3, vertex 1"), and is only called if it is not finite.
  template <typename Where>
  void AddPosition(const Vec3d& position, Where where);

  // Ends a face, whose corners were appended to faces.vertices. kLimit if corners have run out of indices.
  Status EndFace();
};

template <typename Where>
void PolygonMesh::AddPosition(const Vec3d& position, Where where) {
  const float sum =
      static_cast<float>(position[0]) * 0 + static_cast<float>(position[1]) * 0 + static_cast<float>(position[2]) * 0;
  if (sum != 0 && not_finite.empty()) not_finite = where();
  positions.push_back(position);
}

// Rounds the colours of vertices, red, green, blue and alpha, to bytes; `losses` counts those that were finer. They are
// in 0..1, or in 0..255 if red, green or blue of any vertex is above 1 and all of them are whole numbers; what is
// beyond is clamped and counted, too. A negative alpha means that a vertex has no colour; it becomes white.
std::vector<std::array<std::uint8_t, 4>> RoundColors(const std::vector<std::array<float, 4>>& colors, Losses& losses);

// Moves the positions of what was parsed, and where one is not finite, into `file`, and leaves the rest of it alone.
void TakePositions(PolygonMesh& parsed, MeshFile& file);

// Makes `file` of what was parsed: triangulates the faces, or, if `settings.first` has the same faces, takes its
// triangles; stores texture coordinates once each, and normals per vertex where the corners of a vertex agree. `parsed`
// is consumed. kCorrupt if a face names a vertex that there is not.
Status FinishMesh(PolygonMesh& parsed, const ReadSettings& settings, MeshFile& file);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "files/corner_attributes.h"

#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "files/triangulation.h"
#include "files/uv_table.h"
#include "geometry/corner_groups.h"

namespace sac {
namespace {

constexpr std::uint32_t kNone = PolygonMesh::kNone;

// The unit normal of a face, zero if it has no area.
Vec3f FaceNormal(const PolygonMesh& parsed, std::size_t face) {
  const Vec3d normal = NewellNormal(parsed.faces, face, parsed.positions);
  const double length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  if (!(length > 0) || !std::isfinite(length)) return {};
  return {static_cast<float>(normal[0] / length), static_cast<float>(normal[1] / length),
          static_cast<float>(normal[2] / length)};
}

// Gives faces with a corner that lacks a normal the face's own there.
void CompleteNormals(PolygonMesh& parsed) {
  std::uint64_t completed = 0;
  for (std::size_t face = 0; face < parsed.faces.size(); ++face) {
    std::uint32_t own = kNone;
    for (std::uint32_t k = parsed.faces.begin(face); k < parsed.faces.ends[face]; ++k) {
      if (parsed.corner_normals[k] != kNone) continue;
      if (own == kNone) {
        own = static_cast<std::uint32_t>(parsed.normals.size());
        parsed.normals.push_back(FaceNormal(parsed, face));
        ++completed;
      }
      parsed.corner_normals[k] = own;
    }
  }
  if (completed > 0) {
    parsed.warnings.push_back("normals are missing on " + std::to_string(completed) + " of " +
                              std::to_string(parsed.faces.size()) + " faces; those get the normals of their planes");
  }
}

// One number for the normals with the same value, for each normal. The two zeros are one value.
std::vector<std::uint32_t> ClassesByValue(std::vector<Vec3f> normals) {
  for (Vec3f& normal : normals) {
    for (float& x : normal) x += 0.0F;
  }
  return ClassesByBits(normals);
}

}  // namespace

void FinishUvs(PolygonMesh& parsed, const std::vector<Triangle>& corners, Mesh& mesh) {
  if (parsed.corner_uvs.empty()) return;
  UvTable table;
  std::uint64_t lacking = 0;
  for (const Triangle& triangle : corners) {
    Triangle uvs{};
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t index = parsed.corner_uvs[triangle[k]];
      uvs[k] = table.Index(index == kNone ? std::array<float, 2>{} : parsed.uvs[index]);
      lacking += index == kNone ? 1 : 0;
    }
    mesh.uv_triangles.push_back(uvs);
  }
  mesh.uvs = table.Take();
  if (lacking > 0) {
    parsed.warnings.push_back("texture coordinates are missing on " + std::to_string(lacking) + " of " +
                              std::to_string(3 * corners.size()) + " corners of triangles; those get 0 0");
  }
}

void FinishNormals(PolygonMesh& parsed, const std::vector<Triangle>& corners, Mesh& mesh) {
  if (parsed.normals.empty()) return;
  if (parsed.corner_normals.empty()) {
    mesh.normals = std::move(parsed.normals);
    return;
  }
  // A vertex without corners takes the normal of its own number if there are as many normals as vertices.
  std::vector<Vec3f> loose;
  if (parsed.normals.size() == parsed.positions.size()) loose = parsed.normals;
  CompleteNormals(parsed);
  mesh.normal_triangles.reserve(corners.size());
  for (const Triangle& t : corners) {
    mesh.normal_triangles.push_back(
        {parsed.corner_normals[t[0]], parsed.corner_normals[t[1]], parsed.corner_normals[t[2]]});
  }
  mesh.normals = std::move(parsed.normals);
  const auto merge = [&](const std::vector<std::uint32_t>& classes) {
    MergeNormals(mesh.triangles, parsed.positions.size(), classes, loose, mesh.normals, mesh.normal_triangles);
  };
  // Most files name one normal for all corners of a vertex: then values need not be compared.
  std::vector<std::uint32_t> indices(mesh.normals.size());
  std::iota(indices.begin(), indices.end(), 0U);
  merge(indices);
  if (!mesh.normal_triangles.empty()) merge(ClassesByValue(mesh.normals));
}

}  // namespace sac

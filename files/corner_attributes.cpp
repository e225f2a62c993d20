// SPDX-License-Identifier: Apache-2.0
#include "files/corner_attributes.h"

#include <bit>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>

#include "files/uv_table.h"

namespace sac {
namespace {

constexpr std::uint32_t kNone = PolygonMesh::kNone;

// The unit normal of a face (Newell's), zero if it has no area.
Vec3f FaceNormal(const PolygonMesh& parsed, std::size_t face) {
  const Faces& faces = parsed.faces;
  const std::uint32_t begin = faces.begin(face);
  Vec3d sum = {};
  for (std::uint32_t k = begin + 1; k + 1 < faces.ends[face]; ++k) {
    Vec3d a = parsed.positions[faces.vertices[k]], b = parsed.positions[faces.vertices[k + 1]];
    for (int i = 0; i < 3; ++i) {
      a[i] -= parsed.positions[faces.vertices[begin]][i];
      b[i] -= parsed.positions[faces.vertices[begin]][i];
    }
    for (int i = 0; i < 3; ++i) sum[i] += a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
  }
  const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  if (!(length > 0) || !std::isfinite(length)) return {};
  return {static_cast<float>(sum[0] / length), static_cast<float>(sum[1] / length),
          static_cast<float>(sum[2] / length)};
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

// Normals of corners, an entry for each vertex and value.
class NormalTable {
 public:
  std::uint32_t Index(std::uint32_t vertex, const Vec3f& normal) {
    Key key = {vertex};
    // The two zeros are one value.
    for (int k = 0; k < 3; ++k) key[k + 1] = std::bit_cast<std::uint32_t>(normal[k] == 0 ? 0.0F : normal[k]);
    const auto [found, added] = index_.try_emplace(key, static_cast<std::uint32_t>(normals_.size()));
    if (added) normals_.push_back(normal);
    return found->second;
  }

  std::vector<Vec3f> Take() { return std::move(normals_); }

 private:
  using Key = std::array<std::uint32_t, 4>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t hash = 0;
      for (const std::uint32_t x : key) hash = (hash ^ x) * 0x9E3779B97F4A7C15U;
      return static_cast<std::size_t>(hash ^ hash >> 32);
    }
  };

  std::vector<Vec3f> normals_;
  std::unordered_map<Key, std::uint32_t, Hash> index_;
};

// One normal per vertex: that of its corners. A vertex without one takes the normal of its own number if there are as
// many normals as vertices, else none. Of `normals`, only the first `own` are the file's.
std::vector<Vec3f> VertexNormals(const PolygonMesh& parsed, const std::vector<std::uint32_t>& of_vertex,
                                 std::size_t own) {
  std::vector<Vec3f> normals;
  normals.reserve(of_vertex.size());
  for (std::size_t v = 0; v < of_vertex.size(); ++v) {
    const std::uint32_t index =
        of_vertex[v] == kNone && own == of_vertex.size() ? static_cast<std::uint32_t>(v) : of_vertex[v];
    normals.push_back(index == kNone ? Vec3f{} : parsed.normals[index]);
  }
  return normals;
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
  const std::size_t own = parsed.normals.size();
  CompleteNormals(parsed);
  std::vector<std::uint32_t> of_vertex(parsed.positions.size(), kNone);
  bool differ = false;
  for (std::size_t j = 0; j < corners.size(); ++j) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t normal = parsed.corner_normals[corners[j][k]];
      std::uint32_t& known = of_vertex[mesh.triangles[j][k]];
      if (known == kNone) known = normal;
      differ |= known != normal && parsed.normals[known] != parsed.normals[normal];
    }
  }
  if (!differ) {
    mesh.normals = VertexNormals(parsed, of_vertex, own);
    return;
  }
  NormalTable table;
  for (std::size_t j = 0; j < corners.size(); ++j) {
    Triangle normals{};
    for (int k = 0; k < 3; ++k) {
      normals[k] = table.Index(mesh.triangles[j][k], parsed.normals[parsed.corner_normals[corners[j][k]]]);
    }
    mesh.normal_triangles.push_back(normals);
  }
  mesh.normals = table.Take();
}

}  // namespace sac

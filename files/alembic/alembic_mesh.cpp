// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/alembic_mesh.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace sac {
namespace {

// The properties of meshes that are no attributes, and what they are called where they are lost (empty: nothing is
// lost).
constexpr std::pair<std::string_view, std::string_view> kKnown[] = {
    {".selfBnds", ""},
    {".childBnds", ""},
    {".faceIndices", ""},
    {".faceCounts", ""},
    {"P", ""},
    {"uv", ""},
    {"N", ""},
    {".arbGeomParams", ""},
    {".userProperties", ""},
    {".velocities", "velocities"},
    {".scheme", "subdivision schemes"},
    {".interpolateBoundary", ""},
    {".faceVaryingInterpolateBoundary", ""},
    {".faceVaryingPropagateCorners", ""},
    {".creaseIndices", "creases"},
    {".creaseLengths", ""},
    {".creaseSharpnesses", ""},
    {".cornerIndices", "sharp corners"},
    {".cornerSharpnesses", ""},
    {".holes", "holes"},
};

void ListLosses(const AlembicProperty& geometry, Losses& losses) {
  for (const AlembicProperty& property : geometry.properties) {
    const auto* known = std::find_if(std::begin(kKnown), std::end(kKnown),
                                     [&property](const auto& entry) { return entry.first == property.name; });
    if (known == std::end(kKnown)) {
      losses.List("attributes", property.name);
    } else if (!known->second.empty()) {
      losses.Count(known->second);
    }
  }
  if (const AlembicProperty* own = geometry.Find(".userProperties")) {
    for (const AlembicProperty& property : own->properties) losses.List("user properties", property.name);
  }
}

bool IsColor(const AlembicProperty& property) {
  const std::string_view as = MetadataValue(property.metadata, "interpretation");
  return as == "rgb" || as == "rgba";
}

// Turns the corners of each face round.
template <typename Value>
void TurnRound(const Faces& faces, std::vector<Value>& of_corners) {
  for (std::size_t face = 0; face < faces.size(); ++face) {
    std::reverse(of_corners.begin() + faces.begin(face), of_corners.begin() + faces.ends[face]);
  }
}

// Appends indices of corners into a list that has grown to `values` values before. Corners before the first mesh that
// has any have none.
void AppendCorners(const std::vector<std::uint32_t>& indices, std::size_t corners_before, std::size_t values,
                   std::vector<std::uint32_t>& of_corners) {
  of_corners.resize(corners_before, PolygonMesh::kNone);
  for (const std::uint32_t index : indices) of_corners.push_back(static_cast<std::uint32_t>(values + index));
}

std::string DoesNotFit(const std::string& name, const std::string& what) {
  return name + ": its " + what + " do not fit its faces, and are left out";
}

}  // namespace

Status AlembicMesh::OpenAttributes(AlembicArchive& archive, const AlembicProperty& attributes, Losses& losses) {
  for (const AlembicProperty& property : attributes.properties) {
    if (!IsColor(property)) {
      const bool uvs = MetadataValue(property.metadata, "podExtent") == "2" &&
                       MetadataValue(property.metadata, "interpretation") == "vector";
      losses.List(uvs ? "further texture coordinates" : "attributes", property.name);
      continue;
    }
    AlembicAttribute colors;
    SAC_RETURN_IF_ERROR(AlembicAttribute::Open(archive, property, colors));
    if (colors_.any() || !colors.any() || colors.components() < 3 || colors.components() > 4) {
      losses.List("further colors", property.name);
      continue;
    }
    colors_ = std::move(colors);
    colors_name_ = property.name;
  }
  return Status::Ok();
}

Status AlembicMesh::OpenGeometry(AlembicArchive& archive, const AlembicProperty& geometry, Losses& losses) {
  const AlembicProperty* points = geometry.Find("P");
  const AlembicProperty* indices = geometry.Find(".faceIndices");
  const AlembicProperty* counts = geometry.Find(".faceCounts");
  if (points == nullptr || indices == nullptr || counts == nullptr) return Status::Corrupt("without points or faces");
  SAC_RETURN_IF_ERROR(AlembicSamples::Open(archive, *points, points_));
  SAC_RETURN_IF_ERROR(AlembicSamples::Open(archive, *indices, face_indices_));
  SAC_RETURN_IF_ERROR(AlembicSamples::Open(archive, *counts, face_counts_));
  if (points->extent != 3) return Status::Corrupt("points of " + std::to_string(points->extent) + " coordinates");
  if (const AlembicProperty* uvs = geometry.Find("uv")) {
    SAC_RETURN_IF_ERROR(AlembicAttribute::Open(archive, *uvs, uvs_));
    if (uvs_.components() != 2) return Status::Corrupt("texture coordinates that are no pairs");
  }
  if (const AlembicProperty* normals = geometry.Find("N")) {
    SAC_RETURN_IF_ERROR(AlembicAttribute::Open(archive, *normals, normals_));
    if (normals_.components() != 3) return Status::Corrupt("normals that do not have three coordinates");
  }
  ListLosses(geometry, losses);
  const AlembicProperty* attributes = geometry.Find(".arbGeomParams");
  return attributes == nullptr ? Status::Ok() : OpenAttributes(archive, *attributes, losses);
}

Status AlembicMesh::Open(AlembicArchive& archive, const AlembicObject& object, AlembicMesh& mesh, Losses& losses) {
  mesh = {};
  const AlembicProperty* geometry = object.properties.Find(".geom");
  if (geometry == nullptr) return Status::Corrupt("a mesh without geometry");
  return mesh.OpenGeometry(archive, *geometry, losses);
}

void AlembicMesh::ListChanges(Losses& changing) const {
  if (uvs_.any() && !uvs_.constant()) changing.Count("texture coordinates");
  if (colors_.any() && !colors_.constant()) changing.List("colors", colors_name_);
}

Status AlembicMesh::Count(double time, std::uint64_t& vertices, std::uint64_t& corners) const {
  vertices = corners = 0;
  if (points_.size() == 0) return Status::Ok();
  SAC_RETURN_IF_ERROR(points_.Count(points_.At(time).low, vertices));
  vertices /= 3;
  return face_indices_.size() == 0 ? Status::Ok() : face_indices_.Count(face_indices_.At(time).low, corners);
}

Status AlembicMesh::HasSameFaces(double a, double b, bool& same) const {
  std::uint64_t vertices_a = 0, vertices_b = 0, corners = 0;
  SAC_RETURN_IF_ERROR(Count(a, vertices_a, corners));
  SAC_RETURN_IF_ERROR(Count(b, vertices_b, corners));
  same = vertices_a == vertices_b;
  for (const AlembicSamples* samples : {&face_indices_, &face_counts_}) {
    if (!same || samples->size() == 0) return Status::Ok();
    const std::uint32_t i = samples->At(a).low, j = samples->At(b).low;
    if (samples->Same(i, j)) continue;
    std::vector<std::int64_t> first, second;
    SAC_RETURN_IF_ERROR(samples->Read(i, first));
    SAC_RETURN_IF_ERROR(samples->Read(j, second));
    same = first == second;
  }
  return Status::Ok();
}

Status AlembicMesh::AddPositions(double time, const Eigen::Affine3d& matrix, const std::string& name,
                                 PolygonMesh& merged) const {
  if (points_.size() == 0) return Status::Ok();
  const AlembicMoment moment = points_.At(time);
  std::vector<double> numbers, next;
  SAC_RETURN_IF_ERROR(points_.Read(moment.low, numbers));
  if (moment.weight > 0 && !points_.Same(moment.low, moment.high)) {
    SAC_RETURN_IF_ERROR(points_.Read(moment.high, next));
    // Where the mesh changes there is nothing between the two.
    if (next.size() != numbers.size()) next.clear();
  }
  for (std::size_t i = 0; i < next.size(); ++i) numbers[i] += moment.weight * (next[i] - numbers[i]);
  const bool moved = !matrix.isApprox(Eigen::Affine3d::Identity(), 0);
  merged.wide = merged.wide || moved || !next.empty();
  for (std::size_t v = 0; 3 * v + 2 < numbers.size(); ++v) {
    Eigen::Vector3d p(numbers[3 * v], numbers[3 * v + 1], numbers[3 * v + 2]);
    if (moved) p = matrix * p;
    merged.AddPosition({p[0], p[1], p[2]}, [&] { return name + ", vertex " + std::to_string(v); });
  }
  return Status::Ok();
}

Status AlembicMesh::ReadFaces(double time, std::uint64_t vertices, Faces& faces) const {
  std::vector<std::int64_t> indices, counts;
  if (face_indices_.size() > 0) SAC_RETURN_IF_ERROR(face_indices_.Read(face_indices_.At(time).low, indices));
  if (face_counts_.size() > 0) SAC_RETURN_IF_ERROR(face_counts_.Read(face_counts_.At(time).low, counts));
  if (indices.size() >= PolygonMesh::kNone) return Status::Limit("more than 2^32 - 2 corners of faces");
  faces.vertices.reserve(indices.size());
  for (const std::int64_t index : indices) {
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertices) {
      return Status::Corrupt("a face of vertex " + std::to_string(index) + ", but there are " +
                             std::to_string(vertices));
    }
    faces.vertices.push_back(static_cast<std::uint32_t>(index));
  }
  std::size_t end = 0;
  for (const std::int64_t count : counts) {
    if (count < 0 || static_cast<std::uint64_t>(count) > indices.size() - end) {
      return Status::Corrupt("faces of more corners than there are");
    }
    end += static_cast<std::size_t>(count);
    faces.ends.push_back(static_cast<std::uint32_t>(end));
  }
  return end == indices.size() ? Status::Ok() : Status::Corrupt("faces of fewer corners than there are");
}

Status AlembicMesh::AddUvs(double time, const Faces& faces, std::size_t vertices, bool turned, const std::string& name,
                           PolygonMesh& merged) const {
  if (!uvs_.any()) return Status::Ok();
  std::vector<float> values;
  std::vector<std::uint32_t> of_corners;
  bool fits = false;
  SAC_RETURN_IF_ERROR(uvs_.Read(time, faces, vertices, values, of_corners, fits));
  if (!fits) {
    merged.warnings.push_back(DoesNotFit(name, "texture coordinates"));
    return Status::Ok();
  }
  if (turned) TurnRound(faces, of_corners);
  AppendCorners(of_corners, merged.faces.vertices.size(), merged.uvs.size(), merged.corner_uvs);
  for (std::size_t i = 0; i + 1 < values.size(); i += 2) merged.uvs.push_back({values[i], values[i + 1]});
  return Status::Ok();
}

Status AlembicMesh::AddNormals(double time, const Faces& faces, std::size_t vertices, bool turned,
                               const Eigen::Affine3d& matrix, const std::string& name, PolygonMesh& merged) const {
  if (!normals_.any()) return Status::Ok();
  std::vector<float> values;
  std::vector<std::uint32_t> of_corners;
  bool fits = false;
  SAC_RETURN_IF_ERROR(normals_.Read(time, faces, vertices, values, of_corners, fits));
  if (!fits) {
    merged.warnings.push_back(DoesNotFit(name, "normals"));
    return Status::Ok();
  }
  if (turned) TurnRound(faces, of_corners);
  AppendCorners(of_corners, merged.faces.vertices.size(), merged.normals.size(), merged.corner_normals);
  // Normals go by the inverse transposed, which the cofactors are but for a factor; a flattened mesh has these, too.
  const Eigen::Matrix3d m = matrix.linear();
  Eigen::Matrix3d cofactors;
  for (int k = 0; k < 3; ++k) cofactors.col(k) = m.col((k + 1) % 3).cross(m.col((k + 2) % 3));
  if (m.determinant() < 0) cofactors = -cofactors;
  const bool moved = !m.isIdentity(0);
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    const Eigen::Vector3d own(values[i], values[i + 1], values[i + 2]);
    const Eigen::Vector3d n = moved ? Eigen::Vector3d((cofactors * own).normalized()) : own;
    merged.normals.push_back({static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])});
  }
  return Status::Ok();
}

Status AlembicMesh::AddColors(double time, const Faces& faces, std::size_t vertices, const std::string& name,
                              MergedMeshes& merged) const {
  if (!colors_.any()) return Status::Ok();
  std::vector<float> values;
  std::vector<std::uint32_t> of_corners;
  bool fits = false;
  SAC_RETURN_IF_ERROR(colors_.Read(time, faces, vertices, values, of_corners, fits));
  if (!fits) {
    merged.mesh.warnings.push_back(DoesNotFit(name, "colors"));
    return Status::Ok();
  }
  constexpr std::array<float, 4> kNoColor = {0, 0, 0, -1};
  const std::size_t n = colors_.components();
  std::vector<std::array<float, 4>> colors(vertices, kNoColor);
  for (std::size_t k = 0; k < of_corners.size(); ++k) {
    const float* value = &values[n * of_corners[k]];
    const std::array<float, 4> color = {value[0], value[1], value[2], n == 4 ? std::max(value[3], 0.0F) : 1.0F};
    std::array<float, 4>& at = colors[faces.vertices[k]];
    if (at != kNoColor && at != color) {
      merged.mesh.losses.List("colors of faces and corners", colors_name_);
      return Status::Ok();
    }
    at = color;
  }
  merged.colors.resize(merged.mesh.positions.size() - vertices, kNoColor);
  merged.colors.insert(merged.colors.end(), colors.begin(), colors.end());
  return Status::Ok();
}

Status AlembicMesh::Add(double time, const Eigen::Affine3d& matrix, const std::string& name,
                        MergedMeshes& merged) const {
  PolygonMesh& mesh = merged.mesh;
  const std::size_t before = mesh.positions.size();
  SAC_RETURN_IF_ERROR(AddPositions(time, matrix, name, mesh));
  const std::size_t vertices = mesh.positions.size() - before;
  Faces faces;
  SAC_RETURN_IF_ERROR(ReadFaces(time, vertices, faces));
  if (faces.vertices.size() >= PolygonMesh::kNone - mesh.faces.vertices.size()) {
    return Status::Limit("more than 2^32 - 2 corners of faces");
  }
  const bool turned = !(matrix.linear().determinant() < 0);
  SAC_RETURN_IF_ERROR(AddUvs(time, faces, vertices, turned, name, mesh));
  SAC_RETURN_IF_ERROR(AddNormals(time, faces, vertices, turned, matrix, name, mesh));
  SAC_RETURN_IF_ERROR(AddColors(time, faces, vertices, name, merged));
  if (turned) TurnRound(faces, faces.vertices);
  const auto corners = static_cast<std::uint32_t>(mesh.faces.vertices.size());
  for (const std::uint32_t v : faces.vertices) mesh.faces.vertices.push_back(static_cast<std::uint32_t>(before + v));
  for (const std::uint32_t end : faces.ends) mesh.faces.ends.push_back(corners + end);
  // Corners of a mesh that lacks what an earlier one has.
  if (!mesh.corner_uvs.empty()) mesh.corner_uvs.resize(mesh.faces.vertices.size(), PolygonMesh::kNone);
  if (!mesh.corner_normals.empty()) mesh.corner_normals.resize(mesh.faces.vertices.size(), PolygonMesh::kNone);
  if (!merged.colors.empty()) merged.colors.resize(mesh.positions.size(), {0, 0, 0, -1});
  return Status::Ok();
}

}  // namespace sac

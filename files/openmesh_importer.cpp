// SPDX-License-Identifier: Apache-2.0
#include "files/openmesh_importer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace sac {

MeshImporter::VertexHandle MeshImporter::add_vertex(const Point& point) {
  positions_.push_back({point[0], point[1], point[2]});
  kernel_.vprops_resize(positions_.size());
  return VertexHandle(static_cast<int>(positions_.size() - 1));
}

void MeshImporter::set_point(VertexHandle v, const Point& point) {
  positions_.at(static_cast<std::size_t>(v.idx())) = {point[0], point[1], point[2]};
}

void MeshImporter::set_color(VertexHandle v, const Point4& c) {
  const auto byte = [](float x) { return x > 0 ? static_cast<std::uint8_t>(std::lround(std::min(x, 1.0F) * 255)) : 0; };
  set_color(v, Rgba(byte(c[0]), byte(c[1]), byte(c[2]), byte(c[3])));
}

MeshImporter::FaceHandle MeshImporter::add_face(const VHandles& vertices) {
  for (const VertexHandle v : vertices) corners_.push_back(v.idx());
  face_ends_.push_back(corners_.size());
  kernel_.fprops_resize(++face_count_);
  return FaceHandle(static_cast<int>(face_count_ - 1));
}

MeshImporter::HalfedgeHandle MeshImporter::add_edge(VertexHandle from, VertexHandle to) {
  halfedges_.push_back({to.idx(), -1});
  halfedges_.push_back({from.idx(), -1});
  return HalfedgeHandle(static_cast<int>(halfedges_.size() - 2));
}

MeshImporter::FaceHandle MeshImporter::add_face(HalfedgeHandle h) {
  face_halfedges_.push_back(h.idx());
  return FaceHandle(static_cast<int>(face_count_++));
}

void MeshImporter::set_next(HalfedgeHandle h, HalfedgeHandle next) {
  halfedges_.at(static_cast<std::size_t>(h.idx())).next = next.idx();
}

void MeshImporter::set_texcoord(HalfedgeHandle h, const Vec2f& uv) {
  const auto index = static_cast<std::size_t>(h.idx());
  if (halfedge_uvs_.size() <= index) halfedge_uvs_.resize(index + 1);
  halfedge_uvs_[index] = {uv[0], uv[1]};
}

Status MeshImporter::WalkFaces() {
  if (!halfedge_uvs_.empty()) halfedge_uvs_.resize(halfedges_.size());
  for (std::size_t face = 0; face < face_halfedges_.size(); ++face) {
    int h = face_halfedges_[face];
    do {
      // A half-edge belongs to one face, so longer loops come from a damaged file.
      if (h < 0 || static_cast<std::size_t>(h) >= halfedges_.size() || corners_.size() == halfedges_.size()) {
        return Status::Corrupt("face " + std::to_string(face) + ": its half-edges form no loop");
      }
      corners_.push_back(halfedges_[h].to);
      if (!halfedge_uvs_.empty()) corner_uvs_.push_back(halfedge_uvs_[h]);
      h = halfedges_[h].next;
    } while (h != face_halfedges_[face]);
    face_ends_.push_back(corners_.size());
  }
  return Status::Ok();
}

Status MeshImporter::CheckIndices() const {
  std::size_t face = 0;
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    while (face_ends_[face] <= k) ++face;
    if (corners_[k] < 0 || static_cast<std::size_t>(corners_[k]) >= positions_.size()) {
      return Status::Corrupt("face " + std::to_string(face) + ": vertex " +
                             std::to_string(static_cast<std::uint32_t>(corners_[k])) + ", but there are " +
                             std::to_string(positions_.size()));
    }
  }
  return Status::Ok();
}

void MeshImporter::FinishUvs(PolygonMesh& parsed) {
  if (!corner_uvs_.empty()) {
    parsed.uvs = std::move(corner_uvs_);
    for (std::uint32_t k = 0; k < parsed.uvs.size(); ++k) parsed.corner_uvs.push_back(k);
  } else if (!vertex_uvs_.empty()) {
    parsed.uvs = std::move(vertex_uvs_);
    parsed.uvs.resize(positions_.size());
    parsed.corner_uvs = parsed.faces.vertices;
  }
}

Status MeshImporter::Finish(PolygonMesh& parsed) {
  SAC_RETURN_IF_ERROR(WalkFaces());
  SAC_RETURN_IF_ERROR(CheckIndices());
  for (std::size_t face = 0, k = 0; face < face_ends_.size(); ++face) {
    for (; k < face_ends_[face]; ++k) parsed.faces.vertices.push_back(static_cast<std::uint32_t>(corners_[k]));
    SAC_RETURN_IF_ERROR(parsed.EndFace());
  }
  FinishUvs(parsed);
  for (std::size_t v = 0; v < positions_.size(); ++v) {
    const Vec3f& p = positions_[v];
    parsed.AddPosition({p[0], p[1], p[2]}, [v] { return "vertex " + std::to_string(v); });
  }
  if (!normals_.empty()) normals_.resize(positions_.size());
  if (!colors_.empty()) colors_.resize(positions_.size(), {255, 255, 255, 255});
  parsed.normals = std::move(normals_);
  parsed.colors = std::move(colors_);
  return Status::Ok();
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "files/openmesh_importer.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "files/uv_table.h"

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

void MeshImporter::FinishUvs(Mesh& mesh) const {
  OpenMesh::FPropHandleT<std::vector<float>> texcoord;  // u, v per corner, as MeshLab writes it
  const bool wedges = kernel_.get_property_handle(texcoord, "texcoord");
  if (!wedges && corner_uvs_.empty() && vertex_uvs_.empty()) return;

  UvTable table;
  std::vector<std::uint32_t> fan;
  for (std::size_t face = 0, begin = 0; face < face_ends_.size(); begin = face_ends_[face++]) {
    const std::size_t count = face_ends_[face] - begin;
    if (count < 3) continue;
    fan.clear();
    for (std::size_t k = 0; k < count; ++k) {
      std::array<float, 2> uv{};
      if (wedges) {
        const auto& list = kernel_.property(texcoord, FaceHandle(static_cast<int>(face)));
        if (list.size() == 2 * count) uv = {list[2 * k], list[2 * k + 1]};
      } else if (!corner_uvs_.empty()) {
        uv = corner_uvs_[begin + k];
      } else if (const auto v = static_cast<std::size_t>(corners_[begin + k]); v < vertex_uvs_.size()) {
        uv = vertex_uvs_[v];
      }
      fan.push_back(table.Index(uv));
    }
    for (std::size_t k = 1; k + 1 < count; ++k) mesh.uv_triangles.push_back({fan[0], fan[k], fan[k + 1]});
  }
  mesh.uvs = table.Take();
}

Status MeshImporter::Finish(Mesh& mesh) {
  SAC_RETURN_IF_ERROR(WalkFaces());
  SAC_RETURN_IF_ERROR(CheckIndices());
  mesh = {};
  for (std::size_t face = 0, begin = 0; face < face_ends_.size(); begin = face_ends_[face++]) {
    for (std::size_t k = begin + 1; k + 1 < face_ends_[face]; ++k) {
      mesh.triangles.push_back({static_cast<std::uint32_t>(corners_[begin]), static_cast<std::uint32_t>(corners_[k]),
                                static_cast<std::uint32_t>(corners_[k + 1])});
    }
  }
  FinishUvs(mesh);
  if (!normals_.empty()) normals_.resize(positions_.size());
  if (!colors_.empty()) colors_.resize(positions_.size(), {255, 255, 255, 255});
  mesh.positions = std::move(positions_);
  mesh.normals = std::move(normals_);
  mesh.colors = std::move(colors_);
  return Status::Ok();
}

}  // namespace sac

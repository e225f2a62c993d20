// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/Mesh/BaseKernel.hh>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "files/polygon_mesh.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Receives what OpenMesh's reader of OM finds and keeps it as lists: no half-edge structure is built, so non-manifold
// edges, degenerate and duplicate faces and isolated vertices all stay, in the order of the file.
class MeshImporter final : public OpenMesh::IO::BaseImporter {
 public:
  using VertexHandle = OpenMesh::VertexHandle;
  using HalfedgeHandle = OpenMesh::HalfedgeHandle;
  using EdgeHandle = OpenMesh::EdgeHandle;
  using FaceHandle = OpenMesh::FaceHandle;
  using StatusInfo = OpenMesh::Attributes::StatusInfo;
  using Vec2f = OpenMesh::Vec2f;
  using Point = OpenMesh::Vec3f;
  using Point4 = OpenMesh::Vec4f;
  using Vec3d = OpenMesh::Vec3d;
  using Rgb = OpenMesh::Vec3uc;
  using Rgba = OpenMesh::Vec4uc;

  // Moves what was read into `parsed`; fails if an index is out of range.
  Status Finish(PolygonMesh& parsed);

  VertexHandle add_vertex(const Point& point) override;
  VertexHandle add_vertex() override { return add_vertex(Point(0, 0, 0)); }
  void set_point(VertexHandle v, const Point& point) override;
  FaceHandle add_face(const VHandles& vertices) override;

  void set_normal(VertexHandle v, const Point& normal) override { Set(normals_, v, {normal[0], normal[1], normal[2]}); }
  void set_normal(VertexHandle v, const Vec3d& normal) override { set_normal(v, Point(normal)); }
  void set_color(VertexHandle v, const Rgba& c) override { Set(colors_, v, {c[0], c[1], c[2], c[3]}); }
  void set_color(VertexHandle v, const Rgb& c) override { Set(colors_, v, {c[0], c[1], c[2], 255}); }
  void set_color(VertexHandle v, const Point& c) override { set_color(v, Point4(c[0], c[1], c[2], 1)); }
  void set_color(VertexHandle v, const Point4& c) override;
  void set_texcoord(VertexHandle v, const Vec2f& uv) override { Set(vertex_uvs_, v, {uv[0], uv[1]}); }
  void set_texcoord(VertexHandle v, const Point& uvw) override { Set(vertex_uvs_, v, {uvw[0], uvw[1]}); }

  // The OM format stores half-edges; their loops are walked by Finish.
  HalfedgeHandle add_edge(VertexHandle from, VertexHandle to) override;
  FaceHandle add_face(HalfedgeHandle h) override;
  void set_next(HalfedgeHandle h, HalfedgeHandle next) override;
  void set_texcoord(HalfedgeHandle h, const Vec2f& uv) override;
  void set_texcoord(HalfedgeHandle h, const Point& uvw) override { set_texcoord(h, Vec2f(uvw[0], uvw[1])); }

  // The reader stores custom properties there.
  OpenMesh::BaseKernel* kernel() override { return &kernel_; }

  std::size_t n_vertices() const override { return positions_.size(); }
  std::size_t n_faces() const override { return face_count_; }
  std::size_t n_edges() const override { return halfedges_.size() / 2; }

  // Not part of a Mesh.
  void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<Vec2f>&) override {}
  void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<Point>&) override {}
  void set_face_texindex(FaceHandle, int) override {}
  void set_halfedge(VertexHandle, HalfedgeHandle) override {}
  void set_status(VertexHandle, const StatusInfo&) override {}
  void set_face(HalfedgeHandle, FaceHandle) override {}
  void request_face_texcoords2D() override {}
  void set_status(HalfedgeHandle, const StatusInfo&) override {}
  void set_color(EdgeHandle, const Rgb&) override {}
  void set_color(EdgeHandle, const Rgba&) override {}
  void set_color(EdgeHandle, const Point&) override {}
  void set_color(EdgeHandle, const Point4&) override {}
  void set_status(EdgeHandle, const StatusInfo&) override {}
  void set_normal(FaceHandle, const Point&) override {}
  void set_normal(FaceHandle, const Vec3d&) override {}
  void set_color(FaceHandle, const Rgb&) override {}
  void set_color(FaceHandle, const Rgba&) override {}
  void set_color(FaceHandle, const Point&) override {}
  void set_color(FaceHandle, const Point4&) override {}
  void set_status(FaceHandle, const StatusInfo&) override {}
  void add_texture_information(int, std::string) override {}

 private:
  struct Kernel final : OpenMesh::BaseKernel {
    explicit Kernel(const MeshImporter& o) : owner(o) {}
    using BaseKernel::fprops_resize;
    using BaseKernel::vprops_resize;
    std::size_t n_vertices() const override { return owner.n_vertices(); }
    std::size_t n_edges() const override { return owner.n_edges(); }
    std::size_t n_halfedges() const override { return owner.halfedges_.size(); }
    std::size_t n_faces() const override { return owner.n_faces(); }
    const MeshImporter& owner;
  };
  struct Halfedge {
    int to = -1, next = -1;
  };

  template <typename T>
  void Set(std::vector<T>& values, VertexHandle v, const T& value) {
    if (values.size() < positions_.size()) values.resize(positions_.size());
    if (v.idx() >= 0 && static_cast<std::size_t>(v.idx()) < values.size()) values[v.idx()] = value;
  }
  Status WalkFaces();
  Status CheckIndices() const;
  void FinishUvs(PolygonMesh& parsed);

  Positions positions_;
  std::vector<Vec3f> normals_;
  std::vector<std::array<std::uint8_t, 4>> colors_;
  std::vector<std::array<float, 2>> vertex_uvs_;
  std::vector<int> corners_;            // vertices of all faces, one face after the other
  std::vector<std::size_t> face_ends_;  // end of each face in corners_
  std::vector<std::array<float, 2>> corner_uvs_;
  std::vector<Halfedge> halfedges_;
  std::vector<std::array<float, 2>> halfedge_uvs_;
  std::vector<int> face_halfedges_;
  std::size_t face_count_ = 0;
  Kernel kernel_{*this};
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenMesh/Core/IO/exporter/BaseExporter.hh>
#include <OpenMesh/Core/Mesh/BaseKernel.hh>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "sac/mesh.h"

namespace sac {

// Shows a Mesh to OpenMesh's PLY and OFF writers, without a half-edge structure. The mesh must outlive it.
class MeshExporter final : public OpenMesh::IO::BaseExporter {
 public:
  using VertexHandle = OpenMesh::VertexHandle;
  using HalfedgeHandle = OpenMesh::HalfedgeHandle;
  using EdgeHandle = OpenMesh::EdgeHandle;
  using FaceHandle = OpenMesh::FaceHandle;
  using StatusInfo = OpenMesh::Attributes::StatusInfo;
  using Vec2f = OpenMesh::Vec2f;
  using Point = OpenMesh::Vec3f;
  using Vec4f = OpenMesh::Vec4f;
  using Vec3d = OpenMesh::Vec3d;
  using Vec3uc = OpenMesh::Vec3uc;
  using Vec4uc = OpenMesh::Vec4uc;
  using Vec3ui = OpenMesh::Vec3ui;
  using Vec4ui = OpenMesh::Vec4ui;

  explicit MeshExporter(const Mesh& mesh) : mesh_(mesh) {
    if (!mesh.uvs.empty()) AtVertices(mesh.uvs, mesh.uv_triangles, vertex_uvs_);
    if (mesh.normal_triangles.empty()) {
      vertex_normals_ = mesh.normals;
    } else {
      AtVertices(mesh.normals, mesh.normal_triangles, vertex_normals_);
    }
  }

  Point point(VertexHandle v) const override { return Point(mesh_.positions[v.idx()].data()); }
  Vec3d pointd(VertexHandle v) const override { return Vec3d(point(v)); }
  Point normal(VertexHandle v) const override { return Point(vertex_normals_[v.idx()].data()); }
  Vec3d normald(VertexHandle v) const override { return Vec3d(normal(v)); }
  Vec4uc colorA(VertexHandle v) const override { return Vec4uc(mesh_.colors[v.idx()].data()); }
  Vec3uc color(VertexHandle v) const override { return Vec3uc(mesh_.colors[v.idx()].data()); }
  Vec3ui colori(VertexHandle v) const override { return Vec3ui(color(v)); }
  Vec4ui colorAi(VertexHandle v) const override { return Vec4ui(colorA(v)); }
  Point colorf(VertexHandle v) const override { return Point(color(v)) / 255.0F; }
  Vec4f colorAf(VertexHandle v) const override { return Vec4f(colorA(v)) / 255.0F; }
  Vec2f texcoord(VertexHandle v) const override { return Vec2f(vertex_uvs_[v.idx()].data()); }

  unsigned int get_vhandles(FaceHandle f, std::vector<VertexHandle>& vertices) const override {
    vertices.clear();
    for (const std::uint32_t v : mesh_.triangles[f.idx()]) vertices.emplace_back(static_cast<int>(v));
    return 3;
  }

  std::size_t n_vertices() const override { return mesh_.positions.size(); }
  std::size_t n_faces() const override { return mesh_.triangles.size(); }
  std::size_t n_edges() const override { return 0; }
  bool is_triangle_mesh() const override { return true; }
  // False also where the corners of a vertex differ; likewise of texture coordinates.
  bool has_vertex_normals() const override { return !vertex_normals_.empty(); }
  bool has_vertex_colors() const override { return !mesh_.colors.empty(); }
  bool has_vertex_texcoords() const override { return !vertex_uvs_.empty(); }

  // The PLY writer looks for custom properties there.
  const OpenMesh::BaseKernel* kernel() override { return &kernel_; }

  // Not part of a Mesh.
  bool is_point_double() const override { return false; }
  bool is_normal_double() const override { return false; }
  Vec2f texcoord(HalfedgeHandle) const override { return Vec2f(0, 0); }
  StatusInfo status(VertexHandle) const override { return {}; }
  HalfedgeHandle getHeh(FaceHandle, VertexHandle) const override { return HalfedgeHandle(); }
  unsigned int get_face_texcoords(std::vector<Vec2f>&) const override { return 0; }
  Point normal(FaceHandle) const override { return Point(0, 0, 0); }
  Vec3d normald(FaceHandle) const override { return Vec3d(0, 0, 0); }
  Vec3uc color(FaceHandle) const override { return Vec3uc(0, 0, 0); }
  Vec4uc colorA(FaceHandle) const override { return Vec4uc(0, 0, 0, 0); }
  Vec3ui colori(FaceHandle) const override { return Vec3ui(0, 0, 0); }
  Vec4ui colorAi(FaceHandle) const override { return Vec4ui(0, 0, 0, 0); }
  Point colorf(FaceHandle) const override { return Point(0, 0, 0); }
  Vec4f colorAf(FaceHandle) const override { return Vec4f(0, 0, 0, 0); }
  StatusInfo status(FaceHandle) const override { return {}; }
  Vec3uc color(EdgeHandle) const override { return Vec3uc(0, 0, 0); }
  Vec4uc colorA(EdgeHandle) const override { return Vec4uc(0, 0, 0, 0); }
  Vec3ui colori(EdgeHandle) const override { return Vec3ui(0, 0, 0); }
  Vec4ui colorAi(EdgeHandle) const override { return Vec4ui(0, 0, 0, 0); }
  Point colorf(EdgeHandle) const override { return Point(0, 0, 0); }
  Vec4f colorAf(EdgeHandle) const override { return Vec4f(0, 0, 0, 0); }
  StatusInfo status(EdgeHandle) const override { return {}; }
  int get_halfedge_id(VertexHandle) override { return -1; }
  int get_halfedge_id(FaceHandle) override { return -1; }
  int get_next_halfedge_id(HalfedgeHandle) override { return -1; }
  int get_to_vertex_id(HalfedgeHandle) override { return -1; }
  int get_face_id(HalfedgeHandle) override { return -1; }
  StatusInfo status(HalfedgeHandle) const override { return {}; }

 private:
  // Fills `at_vertices` with the values of the vertices' corners; leaves it empty where those of a vertex differ.
  template <class Value>
  void AtVertices(const std::vector<Value>& values, const std::vector<Triangle>& corners,
                  std::vector<Value>& at_vertices) const {
    std::vector<Value> found(mesh_.positions.size());
    std::vector<bool> seen(mesh_.positions.size());
    for (std::size_t j = 0; j < mesh_.triangles.size(); ++j) {
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh_.triangles[j][k];
        const Value& value = values[corners[j][k]];
        if (seen[v] && found[v] != value) return;
        seen[v] = true;
        found[v] = value;
      }
    }
    at_vertices = std::move(found);
  }

  const Mesh& mesh_;
  OpenMesh::BaseKernel kernel_;
  std::vector<std::array<float, 2>> vertex_uvs_;
  std::vector<Vec3f> vertex_normals_;
};

}  // namespace sac

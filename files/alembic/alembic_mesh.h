// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "files/alembic/alembic_attribute.h"
#include "files/alembic/alembic_samples.h"
#include "files/losses.h"
#include "files/polygon_mesh.h"

namespace sac {

// Meshes of a scene one after the other, at one moment, in the coordinates of the scene.
struct MergedMeshes {
  PolygonMesh mesh;  // without colors
  // Of vertices: red, green, blue and alpha; a negative alpha for a vertex without color. Empty where none has any.
  std::vector<std::array<float, 4>> colors;
};

// A mesh of schema AbcGeom_PolyMesh or AbcGeom_SubD, whose control mesh stands for the surface. Alembic's faces go
// round the other way than those of all other formats; here they go round as everywhere. Facts: Alembic's sources,
// lib/Alembic/AbcGeom/IPolyMesh.h, ISubD.h.
class AlembicMesh {
 public:
  // Adds what is not kept to `losses`. kCorrupt: without points or faces, or with damaged properties.
  static Status Open(AlembicArchive& archive, const AlembicObject& object, AlembicMesh& mesh, Losses& losses);

  const AlembicSamples& points() const { return points_; }
  const AlembicSamples& face_indices() const { return face_indices_; }
  // Adds to `changing` what later frames hold and no frame keeps.
  void ListChanges(Losses& changing) const;

  // The numbers of vertices and corners at `time`, seconds.
  Status Count(double time, std::uint64_t& vertices, std::uint64_t& corners) const;

  // Whether the faces and the number of vertices are the same at two times.
  Status HasSameFaces(double a, double b, bool& same) const;

  // Adds the positions at `time` to `merged`. Between samples positions are linear. `name` begins the place of one that
  // is not finite.
  Status AddPositions(double time, const Eigen::Affine3d& matrix, const std::string& name, PolygonMesh& merged) const;

  // Adds the whole mesh. Faces are turned round where the matrix is a reflection, so that they still face the same
  // side.
  Status Add(double time, const Eigen::Affine3d& matrix, const std::string& name, MergedMeshes& merged) const;

 private:
  Status OpenGeometry(AlembicArchive& archive, const AlembicProperty& geometry, Losses& losses);
  Status OpenAttributes(AlembicArchive& archive, const AlembicProperty& attributes, Losses& losses);
  Status ReadFaces(double time, std::uint64_t vertices, Faces& faces) const;
  Status AddUvs(double time, const Faces& faces, std::size_t vertices, bool turned, const std::string& name,
                PolygonMesh& merged) const;
  Status AddNormals(double time, const Faces& faces, std::size_t vertices, bool turned, const Eigen::Affine3d& matrix,
                    const std::string& name, PolygonMesh& merged) const;
  Status AddColors(double time, const Faces& faces, std::size_t vertices, const std::string& name,
                   MergedMeshes& merged) const;

  AlembicSamples points_, face_indices_, face_counts_;
  AlembicAttribute uvs_, normals_, colors_;
  std::string colors_name_;
};

}  // namespace sac

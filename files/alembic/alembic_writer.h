// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "files/alembic/alembic_tree.h"
#include "files/alembic/ogawa_writer.h"
#include "files/scene_writer.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Writes a clip as an Alembic file (Ogawa): a mesh NAMEShape of schema AbcGeom_PolyMesh under a transform NAME, with
// texture coordinates, normals and vertex colors (`Cd`). It appears under its name with Commit. Messages start with the
// path.
class AlembicWriter : public SceneWriter {
 public:
  struct Settings {
    double fps = 24;  // frames a second
    // Is added to all positions, in double precision: it becomes the transform's translation.
    std::array<double, 3> offset = {};
  };

  // `mesh` gives triangles and attributes, `normal_triangles` as Mesh has them; the name of the objects is that of the
  // file.
  Status Open(const std::string& path, const Mesh& mesh, const Settings& settings);

  // Appends a frame. `number` of the first frame, over the rate, is its time. `normals`: as many in every frame, or
  // none.
  Status Write(std::int64_t number, const Positions& positions, const std::vector<Vec3f>& normals) override;

  // Completes the file and gives it its name; kInvalidArgument if there was no frame.
  Status Commit() override;

 private:
  Status WriteFaces(const Mesh& mesh);
  Status WriteTransform();
  AlembicPropertyTree Geometry() const;
  AlembicPropertyTree Transform() const;
  std::string TimeSamplings() const;

  OgawaWriter file_;
  Settings settings_;
  std::string name_;
  double start_ = 0;  // seconds
  AlembicSampleList inherits_, operations_, numbers_, not_identity_;
  AlembicSampleList box_, points_, face_indices_, face_counts_, uvs_, uv_indices_, normals_, normal_indices_, colors_;
  AlembicSampleList sample_count_;
};

}  // namespace sac

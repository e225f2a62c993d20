// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "files/gltf/gltf_builder.h"
#include "files/output_file.h"
#include "files/scene_writer.h"
#include "files/split_vertices.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

struct GltfOutput {
  double fps = 24;                    // frames a second
  std::array<double, 3> offset = {};  // of all positions; becomes the node's translation
  GltfCompression compression = GltfCompression::kNone;
};

// Writes a clip as .glb or .gltf, whose buffer is within: the first frame is the mesh, each other a morph target with
// the differences from it, and an animation blends from one to the next. Vertices keep their order; where corners of
// one differ in normals or texture coordinates, its doubles come after all others. Memory is that of all frames.
//
// Quantized positions have steps of 1/32766 of the largest side of the box of all frames.
class GltfWriter : public SceneWriter {
 public:
  GltfWriter() = default;
  // `mesh` as for ClipOutput.
  Status Open(const std::string& path, const Mesh& mesh, const GltfOutput& settings);

  // The bytes of a .glb of a single frame; nothing is written. Not to be mixed with the others.
  Status FormatFrame(const std::string& path, const Mesh& mesh, const Positions& positions,
                     const std::vector<Vec3f>& normals, std::string& bytes);

  Status Write(std::int64_t number, const Positions& positions, const std::vector<Vec3f>& normals) override;
  Status Commit() override;
  Warnings warnings() const override;

 private:
  struct Grid;
  Status Format(std::string& bytes);
  void AddMesh(GltfBuilder& builder, const Grid& grid) const;
  void AddTargets(GltfBuilder& builder, const Grid& grid) const;
  void AddAnimation(GltfBuilder& builder) const;
  Grid ChooseGrid() const;

  OutputFile file_;
  std::string path_;
  Mesh mesh_;
  SplitVertices split_;
  GltfOutput settings_;
  std::vector<Positions> frames_;
  std::vector<std::vector<Vec3f>> normals_;  // of each frame; empty without
};

}  // namespace sac

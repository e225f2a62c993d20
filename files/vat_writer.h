// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "files/output_file.h"
#include "files/scene_writer.h"
#include "files/split_vertices.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// True for .vat in any case.
bool IsVatName(const std::string& path);

struct VatSettings {
  double fps = 24;                    // frames a second
  std::array<double, 3> offset = {};  // of all positions
  bool exr = false;                   // textures are OpenEXR of 32-bit floats, else PNG of 16 bits
  bool force = false;                 // replace the files beside
};

// The files of a vertex animation texture x.vat: itself, both textures and the mesh.
std::vector<std::string> FilesOfVat(const std::string& path, bool exr);

// Writes a clip as vertex animation textures, which a vertex shader reads (examples/vat.glsl): x.vat is JSON, beside it
// x_positions.png and x_normals.png (or .exr) have a texel for each vertex and frame, and x.glb is the first frame with
// its vertices in the order of texels.
//
// Vertex v of frame f is texel (v % width, f * rows + v / width), counted from the first row of the file. Its value is
// bias + scale * texel, where the texel's red, green and blue are 0..1 in PNG, and numbers of any size in OpenEXR.
// JSON: `vertices`, `frames`, `fps`, `width`, `rows` (of a frame), `height`, `offset` (to be added in double
// precision), `low` and `high` (the box of all frames, without it), `mesh`, and `positions` and `normals` with `file`,
// `scale` and `bias`. Normals are those of the mesh, or, where it has none, means of the triangles' by area. Memory is
// that of all frames.
class VatWriter : public SceneWriter {
 public:
  Status Open(const std::string& path, const Mesh& mesh, const VatSettings& settings);
  Status Write(std::int64_t number, const Positions& positions, const std::vector<Vec3f>& normals) override;
  Status Commit() override;
  Warnings warnings() const override;

 private:
  // Texels of all frames, row after row; those beyond the last vertex of a frame are 0.
  struct Texture {
    std::vector<Vec3f> texels;
    std::array<double, 3> scale = {1, 1, 1}, bias = {};
  };
  Status ChooseLayout();
  std::size_t Texel(std::size_t frame, std::size_t vertex) const;
  Texture PositionTexture() const;
  Texture NormalTexture() const;
  Status WriteTexture(const std::string& path, const Texture& texture);
  Status WriteMeshFile(const std::string& path);
  // `named`: whether the user has named the file.
  Status Keep(const std::string& path, const std::string& bytes, bool named);

  std::string path_;
  Mesh mesh_;
  VatSettings settings_;
  SplitVertices split_;
  std::size_t width_ = 0, rows_ = 0;
  std::array<double, 3> low_ = {}, high_ = {};
  std::vector<Positions> frames_;
  std::vector<std::vector<Vec3f>> normals_;
  std::vector<OutputFile> files_;  // written and closed, under temporary names
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files/cache_file.h"
#include "files/frame_pattern.h"
#include "files/obj_template.h"
#include "files/output_file.h"
#include "files/scene_writer.h"
#include "files/warnings.h"
#include "sac/frame_normals.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// The decoder's output: a cache x.pc2 or x.mdd with the mesh beside it as x.obj, or mesh files under a pattern such as
// x_%04d.obj (.ply, .off), or a single mesh file for a single frame, or a scene x.abc, x.glb, x.gltf or x.usda, or
// vertex animation textures x.vat with the files beside it (files/vat_writer.h). Nothing stands under a final name
// before Commit; what was written is removed if that does not come. Every message starts with the path of the file at
// fault.
class ClipOutput {
 public:
  // How a scene stores numbers.
  enum class Compression { kNone, kQuantized, kMeshopt };

  struct Settings {
    double fps = 24;                           // frames a second, for the times of an MDD or a scene
    std::optional<std::uint32_t> frame_count;  // where known; see CacheWriter::Open
    bool force = false;                        // replace the mesh beside a cache
    Compression compression = Compression::kNone;
    bool z_up = false;  // what a scene says of its axes; else y is up
    bool exr = false;   // vertex animation textures are OpenEXR, not PNG
    // Is added to all positions, model units. Mesh files hold the sum in double precision, caches the nearest float.
    std::array<double, 3> offset = {};
    // With it OBJ files have its text, and the frame's positions; it must outlive the output. `mesh` has its vertices.
    const ObjTemplate* obj = nullptr;
    // The largest error of that rounding that needs no warning, model units.
    double precision = 0;
  };

  // True if `path` is, by its name, a clip output.
  static bool IsClipName(const std::string& path);
  // What is wrong with the name of what is none.
  static std::string NameError(const std::string& path);

  // A warning of files of the sequence that have higher numbers than the last one written, from an earlier run; none
  // where there are none, and for what is no sequence.
  Warnings StaleFrames() const;

  // `mesh` gives triangles and attributes. If it has normals, they are those of its positions.
  static Status Open(const std::string& path, const Mesh& mesh, const Settings& settings,
                     std::unique_ptr<ClipOutput>& output);

  // Appends a frame. `number` names its file in a sequence, and gives the first time of a scene; a cache has no
  // numbers. Every mesh file has the normals of its frame, carried over from the mesh (sac/frame_normals.h).
  // kInvalidArgument where a cache cannot hold a coordinate, and where another mesh is there beside a cache, which the
  // user has not named, unless settings.force.
  Status Write(std::int64_t number, const Positions& positions);

  // Goes on with frames of another mesh, such as one of other triangles, from frame `number` on. kUnsupported, with
  // what to do, where the files hold one mesh for all frames.
  Status BeginMesh(std::int64_t number, const Mesh& mesh);

  // Gives all files their names. kInvalidArgument if there was no frame.
  Status Commit();

  // What the files written so far do not hold of the clip; each kind is told of the first file alone.
  Warnings warnings() const;

 private:
  // `named`: whether the user has named the file.
  Status WriteMeshFile(const std::string& path, const Positions& positions, bool named);

  void TakeMesh(const Mesh& mesh);
  Status OpenScene(const Settings& settings);
  Status WriteToCache(std::int64_t number, const Positions& positions);

  std::string path_;
  Mesh mesh_;
  bool force_ = false;
  const ObjTemplate* obj_ = nullptr;
  std::int64_t last_number_ = std::numeric_limits<std::int64_t>::min();
  std::optional<FrameNormals> normals_;
  std::array<double, 3> offset_ = {};
  double precision_ = 0;
  double largest_rounding_ = 0;  // of a coordinate in the cache, model units
  Warnings mesh_warnings_;       // of the first mesh file
  std::optional<FramePattern> pattern_;
  std::unique_ptr<CacheWriter> cache_;
  std::unique_ptr<SceneWriter> scene_;
  std::vector<OutputFile> mesh_files_;  // written and closed, under temporary names
};

}  // namespace sac

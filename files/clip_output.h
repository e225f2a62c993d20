// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files/cache_file.h"
#include "files/frame_pattern.h"
#include "files/output_file.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// The decoder's output: a cache x.pc2 or x.mdd with the mesh beside it as x.obj, or mesh files under a pattern such as
// x_%04d.obj (.ply, .off), or a single mesh file for a single frame. Nothing stands under a final name before Commit;
// what was written is removed if that does not come. Every message starts with the path of the file at fault.
class ClipOutput {
 public:
  struct Settings {
    double fps = 24;                           // frames a second, for the times of an MDD
    std::optional<std::uint32_t> frame_count;  // where known; see CacheWriter::Open
    bool force = false;                        // replace the mesh beside a cache
  };

  // True if `path` is, by its name, a clip output.
  static bool IsClipName(const std::string& path);

  // The numbers after the last one written whose files are there from an earlier run, in words; empty if there are
  // none, and for what is no sequence.
  std::string StaleFrames() const;

  // `mesh` gives triangles and attributes; only the number of its positions matters.
  static Status Open(const std::string& path, const Mesh& mesh, const Settings& settings,
                     std::unique_ptr<ClipOutput>& output);

  // Appends a frame. `number` names its file in a sequence; a cache has no numbers. Normals are those of the mesh, for
  // every frame. The mesh beside a cache has no name of the user's: kInvalidArgument if another is there, unless
  // settings.force.
  Status Write(std::uint64_t number, const Positions& positions);

  // Gives all files their names. kInvalidArgument if there was no frame.
  Status Commit();

 private:
  // `named`: whether the user has named the file.
  Status WriteMeshFile(const std::string& path, const Positions& positions, bool named);

  std::string path_;
  Mesh mesh_;
  bool force_ = false;
  std::int64_t last_number_ = -1;
  std::optional<FramePattern> pattern_;
  std::unique_ptr<CacheWriter> cache_;
  std::vector<OutputFile> mesh_files_;  // written and closed, under temporary names
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "files/cache_file.h"
#include "files/frame_sequence.h"
#include "files/mesh_file.h"
#include "files/scene_reader.h"
#include "files/warnings.h"
#include "files/welding.h"
#include "sac/clip.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

struct ClipInputSettings {
  Gaps gaps = Gaps::kError;
  // Reads the whole frames of a cache that is shorter or longer than its header says, instead of refusing it.
  bool skip_damage = false;
  // Frames a second at which files that hold a whole scene are sampled; unknown: at their own.
  FrameRate rate = {};
  // Which of several of a scene file, by name or number; empty: the first animation, and the scene that the file shows.
  std::string animation = {}, scene = {};
  // Lets the mesh change: a file with another number of vertices or other faces begins a segment. Otherwise it is an
  // error.
  bool segments = false;
  // In place of an offset that is chosen, for clips that are compared with another.
  std::optional<std::array<double, 3>> offset = std::nullopt;
};

// The encoder's input: the frames of a clip one after the other, each with the vertices of the first and finite.
// Memory is one frame, whatever their number. Every message starts with the path of the file at fault.
class ClipInput : public ClipReader {
 public:
  // `arguments` are `mesh.EXT cache.pc2|.mdd`, or what FindSequence() takes: one or several mesh files, a pattern such
  // as `frame_%04d.ply`, or a directory; or one file that holds a whole scene (.gltf, .glb, .abc). Reads the first
  // frame; of several STL files all, because corners are one vertex only if they are at one place in every frame.
  static Status Open(const std::vector<std::string>& arguments, std::unique_ptr<ClipInput>& input,
                     const ClipInputSettings& settings = {});

  // The first frame of the segment: triangles and attributes of its (first) mesh file; with a cache, the positions are
  // the cache's.
  const Mesh& mesh() const override { return file_.mesh; }

  // What the positions of mesh() and of Next are relative to, model units: those of the files are offset() + position.
  // Other than 0 where the first frame is text or double, and so far from the origin that float32 would round it.
  const std::array<double, 3>& offset() const { return offset_; }

  // What of the files is not kept, a line each with the path: of the first from the beginning, of later frames what
  // Next has come upon, once a kind.
  const Warnings& warnings() const { return warnings_; }

  // An MDD and a scene have times, from which the rate is derived; other inputs have none.
  FrameRate rate() const override;

  // At least 1.
  std::optional<std::uint32_t> frame_count() const override;

  // The first file.
  std::string name() const override { return name_; }
  // The cache, the scene, or the frame's own file.
  std::string name_of(std::uint32_t frame) const override;

  // kInvalidArgument for another number of vertices, other faces, or a coordinate that is NaN or infinite.
  Status Next(Positions& frame, bool& end) override;
  Status NextSegment(bool& end) override;
  std::uint32_t first_frame() const override { return first_; }
  Status Rewind() override;

 private:
  Status OpenCache(const std::string& mesh_path, const std::string& cache_path);
  Status OpenSequence();
  // Makes the frame `first` of a sequence or a scene the first of a segment.
  Status BeginSegment(std::uint32_t first);
  // Reads the first frame of the segment.
  Status ReadFirst();
  Status WeldSegment(std::uint32_t first);
  Status ReadFrame(std::uint32_t index, MeshFile& file) const;
  Status NextOfSequence(Positions& frame, bool& end);
  Status NextOfScene(Positions& frame, bool& end);

  // Adds a warning about a frame after the first; `told` remembers that its kind needs no other.
  void Tell(bool& told, const std::string& warning);
  // Remembers that a segment begins with the frame `next`, and tells it with the `reason`.
  void EndSegment(std::uint32_t next, const std::string& reason);
  // Adds what a later file of a sequence holds beyond a frame, where no file before has held the same.
  void TellLosses(const MeshFile& file, const std::string& path);
  void TellChanges(const MeshFile& file, const std::string& path);
  void TellCoarse(const Positions& frame, const std::string& where);

  std::uint32_t frames() const;

  ClipInputSettings settings_;
  std::string name_;
  MeshFile file_;  // the segment's first; `exact` is given up
  std::array<double, 3> offset_ = {};
  std::vector<std::string> paths_;  // of a sequence
  std::optional<Welding> welding_;  // of a sequence of STL files
  std::unique_ptr<CacheReader> cache_;
  std::unique_ptr<SceneReader> scene_;
  Warnings warnings_;
  std::set<std::string> told_losses_;  // warnings of files without their paths
  bool told_colors_ = false, told_uvs_ = false, told_normals_ = false, told_coarse_ = false;
  double diagonal_ = 0;  // of the largest frame so far
  std::uint32_t first_ = 0, next_ = 0;
  bool begun_ = false;            // a segment was begun before
  std::set<std::uint32_t> ends_;  // of segments that were read to their end: the number of the frame after the last
};

}  // namespace sac

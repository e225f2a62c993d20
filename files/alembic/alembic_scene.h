// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "files/alembic/alembic_archive.h"
#include "files/alembic/alembic_mesh.h"
#include "files/alembic/alembic_transform.h"
#include "files/losses.h"
#include "files/polygon_mesh.h"
#include "files/random_access.h"
#include "files/warnings.h"
#include "sac/clip.h"
#include "sac/status.h"

namespace sac {

struct AlembicLimits {
  std::uint32_t objects = 1 << 20;  // instances counted each
  std::uint32_t frames = 1 << 20;
  // At any frame. A small file may hold a large scene, because meshes and instances share what is equal.
  std::uint64_t vertices = 1 << 27;
  std::uint64_t corners = std::uint64_t{1} << 29;
};

// The meshes of an archive under their transforms, as one mesh at any frame. Hidden meshes are left out. Messages name
// the object, but not the file.
class AlembicScene {
 public:
  // With a rate, frames are taken at that; else at the rate of the samples. kInvalidArgument: no mesh that can be seen.
  static Status Open(RandomAccess bytes, const FrameRate& wanted, const AlembicLimits& limits,
                     std::unique_ptr<AlembicScene>& scene);

  FrameRate rate() const { return rate_; }
  std::uint32_t frame_count() const { return frame_count_; }

  // The meshes at a frame, merged, with the losses and warnings of the clip.
  Status ReadMesh(std::uint32_t frame, PolygonMesh& mesh) const;

  // Positions, wide and not_finite at a frame. kUnsupported, naming mesh and frame, where the vertices or faces of a
  // mesh are not those of the frame `first`; ReadMesh() gives them.
  Status ReadPositions(std::uint32_t frame, PolygonMesh& mesh, std::uint32_t first = 0) const;

 private:
  enum Visibility : unsigned { kVisible = 1, kHidden = 2 };  // a set: what an object is at any time

  // A transform in the scene; parents come before their children.
  struct Node {
    std::optional<std::size_t> parent;
    std::shared_ptr<const AlembicTransform> transform;
  };
  struct SceneMesh {
    std::string path;
    std::optional<std::size_t> node;
    std::shared_ptr<const AlembicMesh> mesh;
  };
  // Where Visit() is.
  struct Place {
    std::string path;
    std::optional<std::size_t> node;
    unsigned visibility = kVisible;
    int depth = 0;
  };

  Status Visit(const AlembicObject& object, Place place);
  // Finds the object that an instance, whose `source` names it, shows.
  Status FindOriginal(const AlembicProperty& source, const AlembicObject*& original);
  Status AddNode(const AlembicObject& object, Place& place);
  Status AddMesh(const AlembicObject& object, const Place& place);
  Status ReadVisibility(const AlembicObject& object, const Place& place, unsigned& visibility);
  void ListLoss(const AlembicObject& object, const Place& place);
  void ListPaths(const AlembicObject& object, const std::string& path);

  // Chooses the times of the frames.
  Status ChooseFrames(const FrameRate& wanted);
  std::vector<const AlembicSamples*> MovingSamples() const;
  void TellTimes(const std::vector<const AlembicSamples*>& moving, bool resampled);

  double TimeOf(std::uint32_t frame) const { return start_ + frame * period_; }
  Status Matrices(double time, std::vector<Eigen::Affine3d>& matrices) const;
  Status CheckCounts(double time) const;

  AlembicLimits limits_;
  AlembicArchive archive_;
  std::vector<Node> nodes_;
  std::vector<SceneMesh> meshes_;
  // What has been read of objects, which instances share.
  std::map<const AlembicObject*, std::shared_ptr<const AlembicTransform>> transforms_;
  std::map<const AlembicObject*, std::shared_ptr<const AlembicMesh>> read_meshes_;
  std::unordered_map<std::string, const AlembicObject*> objects_by_path_;  // once there is an instance
  std::map<const AlembicProperty*, const AlembicObject*> originals_;
  std::map<const AlembicObject*, unsigned> visibilities_;  // own ones; 0 stands for those of the parent
  std::uint32_t objects_ = 0;
  std::size_t hidden_ = 0;  // meshes
  Losses losses_;
  Warnings warnings_;

  FrameRate rate_;
  std::uint32_t frame_count_ = 1;
  double start_ = 0, period_ = 1;  // seconds
};

}  // namespace sac

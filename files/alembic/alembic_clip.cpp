// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/alembic_clip.h"

#include <string>
#include <utility>

#include "files/alembic/alembic_scene.h"
#include "files/path.h"
#include "files/polygon_mesh.h"

namespace sac {
namespace {

class AlembicClip : public SceneReader {
 public:
  AlembicClip(std::string path, std::unique_ptr<AlembicScene> scene)
      : path_(std::move(path)), scene_(std::move(scene)) {}

  FrameRate rate() const override { return scene_->rate(); }
  std::uint32_t frame_count() const override { return scene_->frame_count(); }

  Status ReadMesh(std::uint32_t frame, MeshFile& file) override {
    const Status status = Named(path_, [&]() -> Status {
      PolygonMesh mesh;
      SAC_RETURN_IF_ERROR(scene_->ReadMesh(frame, mesh));
      if (mesh.positions.empty()) {
        return Status::InvalidArgument(frame == 0 ? "no vertices in the first frame"
                                                  : "no vertices in frame " + std::to_string(frame));
      }
      return FinishMesh(mesh, {}, file);
    });
    if (!status.ok()) return status;
    for (std::string& warning : file.warnings) warning = path_ + ": " + warning;
    return Status::Ok();
  }

  Status ReadPositions(std::uint32_t frame, std::uint32_t first, MeshFile& file) override {
    return Named(path_, [&]() -> Status {
      PolygonMesh mesh;
      SAC_RETURN_IF_ERROR(scene_->ReadPositions(frame, mesh, first));
      TakePositions(mesh, file);
      return Status::Ok();
    });
  }

 private:
  std::string path_;
  std::unique_ptr<AlembicScene> scene_;
};

}  // namespace

bool IsAlembicName(const std::string& path) { return Extension(path) == ".abc"; }

Status OpenAlembicClip(const std::string& path, const FrameRate& wanted, std::unique_ptr<SceneReader>& reader) {
  return Named(path, [&]() -> Status {
    RandomAccess bytes;
    SAC_RETURN_IF_ERROR(bytes.Open(path));
    std::unique_ptr<AlembicScene> scene;
    SAC_RETURN_IF_ERROR(AlembicScene::Open(std::move(bytes), wanted, {}, scene));
    reader = std::make_unique<AlembicClip>(path, std::move(scene));
    return Status::Ok();
  });
}

}  // namespace sac

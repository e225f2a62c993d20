// SPDX-License-Identifier: Apache-2.0
// An Alembic file: it opens or fails, and every frame that it announces is read or refused. What is read is consistent,
// and the positions of a frame are those of its mesh.
#include <memory>
#include <string>

#include "files/alembic/alembic_scene.h"
#include "files/polygon_mesh.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace sac;

AlembicLimits SmallLimits() {
  AlembicLimits limits;
  limits.objects = 200;
  limits.frames = 50;
  limits.vertices = 2000;
  limits.corners = 4000;
  return limits;
}

void CheckMesh(const MeshFile& file) {
  const Mesh& mesh = file.mesh;
  const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
  FUZZ_REQUIRE(file.exact.empty() || file.exact.size() == vertices);
  FUZZ_REQUIRE(mesh.colors.empty() || mesh.colors.size() == vertices);
  FUZZ_REQUIRE(mesh.uv_triangles.empty() || mesh.uv_triangles.size() == mesh.triangles.size());
  FUZZ_REQUIRE(mesh.normal_triangles.empty() || mesh.normal_triangles.size() == mesh.triangles.size());
  const auto in_range = [](const std::vector<Triangle>& triangles, std::size_t end) {
    for (const Triangle& triangle : triangles) {
      for (const std::uint32_t index : triangle) FUZZ_REQUIRE(index < end);
    }
  };
  in_range(mesh.triangles, vertices);
  in_range(mesh.uv_triangles, mesh.uvs.size());
  in_range(mesh.normal_triangles, mesh.normals.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::unique_ptr<AlembicScene> scene;
  const FrameRate rate = {size % 3 == 0 ? 7U : 0U, 1};
  RandomAccess bytes(std::string(data, data + size));
  if (!AlembicScene::Open(std::move(bytes), rate, SmallLimits(), scene).ok()) return 0;
  FUZZ_REQUIRE(scene->frame_count() >= 1 && scene->frame_count() <= SmallLimits().frames);
  for (std::uint32_t frame = 0; frame < scene->frame_count(); ++frame) {
    PolygonMesh positions, mesh;
    const bool whole = scene->ReadMesh(frame, mesh).ok();
    if (!scene->ReadPositions(frame, positions).ok() || !whole) continue;
    FUZZ_REQUIRE(positions.positions.size() == mesh.positions.size());
    FUZZ_REQUIRE(positions.not_finite == mesh.not_finite && positions.wide == mesh.wide);
    if (mesh.not_finite.empty()) FUZZ_REQUIRE(positions.positions == mesh.positions);
    if (mesh.positions.empty()) continue;
    MeshFile file;
    if (FinishMesh(mesh, {}, file).ok()) CheckMesh(file);
  }
  return 0;
}

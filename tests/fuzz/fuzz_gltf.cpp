// SPDX-License-Identifier: Apache-2.0
// A .gltf or .glb with all its buffers within: its first frame and a few others.
#include <algorithm>

#include "files/gltf/gltf_clip.h"
#include "tests/fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sac;
  GltfSettings settings;
  settings.limits = {.file_bytes = 1 << 20, .values = 1 << 16, .vertices = 1 << 12, .frames = 100, .nodes = 1000};
  std::unique_ptr<SceneReader> clip;
  if (!ParseGltfClip("fuzzed", std::span(data, size), settings, clip).ok()) return 0;
  FUZZ_REQUIRE(clip->frame_count() >= 1 && clip->frame_count() <= 100);
  MeshFile first;
  if (!clip->ReadMesh(0, first).ok()) return 0;
  const std::size_t vertices = first.mesh.positions.size();
  FUZZ_REQUIRE(vertices >= 1 && vertices <= 1 << 12);
  for (const Triangle& t : first.mesh.triangles) FUZZ_REQUIRE(*std::max_element(t.begin(), t.end()) < vertices);
  FUZZ_REQUIRE(first.mesh.colors.empty() || first.mesh.colors.size() == vertices);
  for (std::uint32_t frame = 0; frame < clip->frame_count(); frame += 30) {
    MeshFile file;
    if (!clip->ReadPositions(frame, 0, file).ok()) continue;
    FUZZ_REQUIRE(file.mesh.positions.size() == vertices);
    FUZZ_REQUIRE(frame > 0 || !first.not_finite.empty() || file.mesh.positions == first.mesh.positions);
  }
  return 0;
}

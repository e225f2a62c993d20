// SPDX-License-Identifier: Apache-2.0
#include "sac/clip_encoder.h"

#include <gtest/gtest.h>

#include "tests/hard_cube.h"

namespace sac {
namespace {

EncodedClip EncodeStill(const Mesh& mesh) {
  const Clip clip{mesh, {mesh.positions}};
  MemoryClipReader reader(clip);
  EncodedClip result;
  const Status status = EncodeClip(reader, {}, {}, result);
  EXPECT_TRUE(status.ok()) << status.message();
  return result;
}

TEST(EncodeClip, TellsOfAttributesThatAreLost) {
  const EncodedClip cube = EncodeStill(HardCubeMesh());
  EXPECT_FALSE(cube.lost_normals);
  EXPECT_FALSE(cube.lost_texture_coordinates);  // there are none

  // Draco codes no degenerate triangle.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}};
  mesh.triangles = {{0, 1, 1}, {1, 0, 0}};
  mesh.normals = {{0, 0, 1}, {1, 0, 0}};
  mesh.normal_triangles = {{0, 0, 0}, {1, 1, 1}};
  EXPECT_TRUE(EncodeStill(mesh).lost_normals);
  mesh.normal_triangles.clear();  // those of vertices are kept
  EXPECT_FALSE(EncodeStill(mesh).lost_normals);
  mesh.uvs = {{0, 0}};
  mesh.uv_triangles = {{0, 0, 0}, {0, 0, 0}};
  EXPECT_TRUE(EncodeStill(mesh).lost_texture_coordinates);
}

TEST(EncodeClip, RefusesAMeshThatIsNoneBeforeItMeasures) {
  const Clip cube{HardCubeMesh(), {HardCubeMesh().positions, HardCubeMesh().positions}};
  Clip broken = cube;
  broken.mesh.triangles[5][1] = 1u << 30;
  MemoryClipReader reader(broken);
  EncodedClip result;
  for (const std::uint32_t rounds : {0u, 1u}) {
    ClipEncoding encoding;
    encoding.reference_rounds = rounds;
    const Status status = EncodeClip(reader, encoding, {}, result);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(status.message(), "a triangle of a missing vertex");
  }
}

}  // namespace
}  // namespace sac

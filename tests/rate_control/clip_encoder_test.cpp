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

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "sac/clip_encoder.h"

#include <gtest/gtest.h>

#include "format/sequence_header.h"
#include "tests/hard_cube.h"
#include "tests/test_packets.h"

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

// Two squares with four vertices at the edge between them, of which one pair comes apart in the last frame.
Clip Opening() {
  Clip clip;
  clip.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}};
  clip.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  for (int f = 0; f < 5; ++f) {
    Positions& frame = clip.frames.emplace_back(clip.mesh.positions);
    for (Vec3f& p : frame) p[2] = 0.1f * static_cast<float>(f) * p[0] * p[1];
    if (f == 4) frame[7][2] += 0.5f;
  }
  return clip;
}

TEST(EncodeClip, JoinsWhatCoincidesInAllFrames) {
  const Clip clip = Opening();
  MemoryClipReader reader(clip);
  ClipEncoding encoding;
  EncodedClip result;
  std::vector<std::uint8_t> stream;
  const auto sink = [&](std::span<const std::uint8_t> bytes) {
    stream.insert(stream.end(), bytes.begin(), bytes.end());
    return Status::Ok();
  };
  const auto header = [&] {
    SequenceHeader parsed;
    EXPECT_TRUE(ParseSequenceHeader(Packets(stream).at(0).payload, {}, parsed).ok());
    return parsed;
  };
  for (const std::uint32_t rounds : {0u, 2u}) {
    stream.clear();
    encoding.reference_rounds = rounds;
    ASSERT_TRUE(EncodeClip(reader, encoding, sink, result).ok());
    EXPECT_EQ(header().vertices, 7u);
    EXPECT_EQ(header().copies, 1u);
    EXPECT_EQ(result.order.size(), 8u);
    EXPECT_EQ(result.positions, 40u);
    EXPECT_EQ(result.distortion.seam_gap, 0);
  }
  stream.clear();
  encoding.encoder.join = false;
  ASSERT_TRUE(EncodeClip(reader, encoding, sink, result).ok());
  EXPECT_EQ(header().vertices, 8u);
}

}  // namespace
}  // namespace sac

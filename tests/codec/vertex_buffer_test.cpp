// SPDX-License-Identifier: Apache-2.0
#include "codec/decode/vertex_buffer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "geometry/bounding_box.h"
#include "geometry/normals.h"
#include "tests/test_clips.h"

namespace sac {
namespace {

struct Vertex {  // as an engine has it
  float position[3];
  std::uint16_t small[3];
  std::int16_t normal[3];
  std::uint32_t other = 77;
};

TEST(VertexBuffer, FillsWhatIsWanted) {
  const Clip clip = BendingClip(1);
  const Positions& p = clip.frames[0];
  const Box box = BoundingBox(p);
  std::vector<Vertex> vertices(p.size());
  const std::size_t bytes = vertices.size() * sizeof(Vertex);
  FrameBuffers floats, shorts;
  floats.positions = {vertices.data()->position, bytes, sizeof(Vertex), VertexFormat::kFloat32};
  shorts.positions = {vertices.data()->small, bytes - offsetof(Vertex, small), sizeof(Vertex), VertexFormat::kInt16};
  shorts.normals = {vertices.data()->normal, bytes - offsetof(Vertex, normal), sizeof(Vertex), VertexFormat::kInt16};
  ASSERT_TRUE(CheckBuffers(floats, p.size()).ok());
  ASSERT_TRUE(CheckBuffers(shorts, p.size()).ok());
  NormalField field;
  FillBuffers(p, clip.mesh.triangles, box, floats, field);
  FillBuffers(p, clip.mesh.triangles, box, shorts, field);
  const std::vector<Vec3f> normals = VertexNormals(p, clip.mesh.triangles);
  for (std::size_t v = 0; v < p.size(); ++v) {
    EXPECT_EQ(std::memcmp(vertices[v].position, p[v].data(), 12), 0);
    EXPECT_EQ(vertices[v].other, 77u);
    for (std::size_t a = 0; a < 3; ++a) {
      const double size = box.high[a] - box.low[a];
      EXPECT_NEAR(box.low[a] + size * vertices[v].small[a] / 65535, p[v][a], size / 65535 * 0.51 + 1e-7);
      EXPECT_NEAR(vertices[v].normal[a] / 32767.0, normals[v][a], 1.0 / 32767);
    }
  }
}

TEST(VertexBuffer, SizesAreChecked) {
  std::vector<std::uint8_t> memory(1000);
  const auto check = [&](std::size_t size, std::size_t stride, VertexFormat format, std::size_t vertices) {
    FrameBuffers buffers;
    buffers.normals = {memory.data(), size, stride, format};
    return CheckBuffers(buffers, vertices).code();
  };
  EXPECT_EQ(check(120, 12, VertexFormat::kFloat32, 10), StatusCode::kOk);
  EXPECT_EQ(check(119, 12, VertexFormat::kFloat32, 10), StatusCode::kInvalidArgument);
  EXPECT_EQ(check(192, 20, VertexFormat::kFloat32, 10), StatusCode::kOk);  // the last one is not padded
  EXPECT_EQ(check(191, 20, VertexFormat::kFloat32, 10), StatusCode::kInvalidArgument);
  EXPECT_EQ(check(1000, 11, VertexFormat::kFloat32, 10), StatusCode::kInvalidArgument);
  EXPECT_EQ(check(60, 6, VertexFormat::kInt16, 10), StatusCode::kOk);
  EXPECT_EQ(check(60, 0, VertexFormat::kInt16, 1), StatusCode::kInvalidArgument);
  EXPECT_EQ(check(0, 12, VertexFormat::kFloat32, 0), StatusCode::kOk);
  EXPECT_EQ(check(~std::size_t{0}, ~std::size_t{0}, VertexFormat::kFloat32, 1), StatusCode::kOk);
  EXPECT_EQ(check(~std::size_t{0}, ~std::size_t{0}, VertexFormat::kFloat32, 3), StatusCode::kInvalidArgument);
}

TEST(VertexBuffer, ABufferThatIsTooSmallCostsNoFrame) {
  const Clip clip = BendingClip(2);
  const std::vector<std::uint8_t> stream = Encode(clip, {}).bytes;
  Decoder decoder;
  std::span<const std::uint8_t> rest(stream);
  while (decoder.mesh() == nullptr) ASSERT_TRUE(decoder.Send(rest).ok());
  std::vector<Vec3f> memory(clip.mesh.positions.size());
  FrameBuffers buffers;
  buffers.positions = {memory.data(), 12 * memory.size() - 1, 12, VertexFormat::kFloat32};
  FrameInfo info;
  EXPECT_EQ(decoder.Receive(buffers, info).code(), StatusCode::kInvalidArgument);
  buffers.positions.size += 1;
  Status status;
  while ((status = decoder.Receive(buffers, info)).code() == StatusCode::kNeedMoreData) {
    ASSERT_TRUE(decoder.Send(rest).ok());
  }
  ASSERT_TRUE(status.ok());
  EXPECT_EQ(info.index, 0u);
  EXPECT_EQ(memory, Decode(stream).frames[0].positions);
}

TEST(VertexNormals, OfASphereAreItsPoints) {
  const Mesh mesh = SphereMesh(8);
  const std::vector<Vec3f> normals = VertexNormals(mesh.positions, mesh.triangles);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    double cosine = 0, length = 0, radius = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto n = static_cast<double>(normals[v][a]), p = static_cast<double>(mesh.positions[v][a]);
      cosine += n * p;
      length += n * n;
      radius += p * p;
    }
    EXPECT_NEAR(length, 1, 1e-6);
    EXPECT_GT(cosine / std::sqrt(radius), 0.999);
  }
}

TEST(VertexNormals, NothingComesOfNoArea) {
  const Positions line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
  for (const Vec3f& n : VertexNormals(line, {{0, 1, 2}})) EXPECT_EQ(n, (Vec3f{0, 0, 0}));
}

}  // namespace
}  // namespace sac

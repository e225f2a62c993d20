// SPDX-License-Identifier: Apache-2.0
// Vertices that coincide are one to the codec and come out as the many that they were (spec.md 5.6).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>

#include "codec/encode/encoded_start.h"
#include "codec/encode/joined_mesh.h"
#include "codec/encode/stream_encoder.h"
#include "tests/hard_cube.h"
#include "tests/test_clips.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

constexpr std::size_t kPlaces = 8, kVertices = 24;

// The cube of 8 places as games have it: each face has four vertices of its own, with their normal, texture coordinate
// and colour.
Mesh SplitCube() {
  const Mesh cube = HardCubeMesh();
  Mesh out;
  for (std::uint32_t j = 0; j < cube.triangles.size(); ++j) {
    Triangle& t = out.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f &position = cube.positions[cube.triangles[j][k]], &normal = cube.normals[j / 2];
      std::uint32_t v = 0;
      while (v < out.positions.size() && (out.positions[v] != position || out.normals[v] != normal)) ++v;
      t[k] = v;
      if (v < out.positions.size()) continue;
      out.positions.push_back(position);
      out.normals.push_back(normal);
      const auto face = static_cast<std::uint8_t>(j / 2);
      out.uvs.push_back({static_cast<float>(face) / 6 + 0.1f * position[j / 4 == 0 ? 1 : 0], position[2]});
      out.colors.push_back({static_cast<std::uint8_t>(40 * face), 7, 9, 255});
    }
  }
  out.uv_triangles = out.triangles;
  return out;
}

Clip Waving(const Mesh& mesh, std::uint32_t frames = 6) {
  Clip clip{mesh, {}, {}};
  for (std::uint32_t f = 0; f < frames; ++f) {
    Positions& frame = clip.frames.emplace_back(mesh.positions);
    for (Vec3f& p : frame)
      p = {p[0] + 0.2f * std::sin(0.5f * f) * p[2], p[1] * (1 + 0.05f * f), p[2] + 0.1f * f * p[0]};
  }
  return clip;
}

EncoderSettings Joining() {
  EncoderSettings settings;
  settings.quality = 70;
  settings.join = settings.keep_order = true;
  return settings;
}

SequenceHeader HeaderOf(const std::vector<std::uint8_t>& stream) {
  SequenceHeader header;
  EXPECT_TRUE(ParseSequenceHeader(Packets(stream).at(0).payload, {}, header).ok());
  return header;
}

// Positions in the author's order.
Positions Ordered(const Positions& decoded, const std::vector<std::uint32_t>& order) {
  Positions out(decoded.size());
  for (std::size_t i = 0; i < decoded.size(); ++i) out.at(order.at(i)) = decoded[i];
  return out;
}

// The largest distance in any frame of vertices that coincide in the mesh.
double Gap(const Mesh& mesh, const Decoded& decoded) {
  double gap = 0;
  for (const DecodedFrame& frame : decoded.frames) {
    const Positions positions = Ordered(frame.positions, decoded.order);
    for (std::size_t a = 0; a < positions.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (mesh.positions[a] != mesh.positions[b]) continue;
        for (std::size_t c = 0; c < 3; ++c) gap = std::max<double>(gap, std::abs(positions[a][c] - positions[b][c]));
      }
    }
  }
  return gap;
}

std::multiset<Triangle> Turned(std::vector<Triangle> triangles, const std::vector<std::uint32_t>& order) {
  std::multiset<Triangle> out;
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = order.at(v);
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    out.insert(t);
  }
  return out;
}

std::vector<std::uint32_t> Same(std::size_t count) {
  std::vector<std::uint32_t> same(count);
  for (std::uint32_t i = 0; i < count; ++i) same[i] = i;
  return same;
}

TEST(JoinedVertices, ComeOutAsTheyWere) {
  const Mesh mesh = SplitCube();
  ASSERT_EQ(mesh.positions.size(), kVertices);
  const Encoded encoded = Encode(Waving(mesh), Joining());
  const SequenceHeader header = HeaderOf(encoded.bytes);
  EXPECT_EQ(header.vertices, kPlaces);
  EXPECT_EQ(header.copies, kVertices - kPlaces);
  for (const std::size_t chunk : {std::size_t{1}, std::size_t{1} << 20}) {
    const Decoded decoded = Decode(encoded.bytes, chunk);
    ASSERT_TRUE(decoded.status.ok()) << decoded.status.message();
    ASSERT_EQ(decoded.order, encoded.order);
    ASSERT_EQ(decoded.mesh.positions.size(), kVertices);
    EXPECT_EQ(Gap(mesh, decoded), 0);
    EXPECT_EQ(Turned(decoded.mesh.triangles, decoded.order), Turned(mesh.triangles, Same(kVertices)));
    ASSERT_EQ(decoded.mesh.colors.size(), kVertices);
    ASSERT_TRUE(decoded.mesh.normal_triangles.empty());
    ASSERT_EQ(decoded.mesh.normals.size(), kVertices);
    for (std::size_t i = 0; i < kVertices; ++i) {
      const std::uint32_t author = decoded.order[i];
      EXPECT_EQ(decoded.mesh.colors[i], mesh.colors[author]);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(decoded.mesh.normals[i][c], mesh.normals[author][c], 0.01);
    }
    ASSERT_EQ(decoded.mesh.uv_triangles.size(), mesh.triangles.size());
    for (std::size_t j = 0; j < mesh.triangles.size(); ++j) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& uv = decoded.mesh.uvs[decoded.mesh.uv_triangles[j][k]];
        const auto& wanted = mesh.uvs[decoded.order[decoded.mesh.triangles[j][k]]];
        EXPECT_NEAR(uv[0], wanted[0], 1e-3);
        EXPECT_NEAR(uv[1], wanted[1], 1e-3);
      }
    }
  }
}

TEST(JoinedVertices, AreApartUnlessToldSo) {
  EncoderSettings settings = Joining();
  for (const std::optional<bool> join : {std::optional<bool>(), std::optional(false)}) {
    settings.join = join;
    const SequenceHeader header = HeaderOf(Encode(Waving(SplitCube()), settings).bytes);
    EXPECT_EQ(header.vertices, kVertices);
    EXPECT_EQ(header.copies, 0u);
  }
}

TEST(JoinedVertices, NothingToJoinChangesNoByte) {
  const Clip clip = Waving(HardCubeMesh());
  EncoderSettings settings = Joining();
  const Encoded joined = Encode(clip, settings);
  settings.join = false;
  EXPECT_EQ(Encode(clip, settings).bytes, joined.bytes);
}

TEST(JoinedVertices, WithoutAttributesWithAnyPlane) {
  Mesh mesh = SplitCube();
  mesh.uvs.clear();
  mesh.uv_triangles.clear();
  mesh.normals.clear();
  mesh.colors.clear();
  for (const int which : {0, 1, 2, 3, 4}) {
    EncoderSettings settings = Joining();
    if (which == 1) settings.detail_step = 0.001;
    if (which == 2) settings.max_error = 0.001;
    if (which == 3) settings.reference_shape = ReferenceShape::kPrevious;
    if (which == 4) settings.low_delay = true;
    const Clip clip = Waving(mesh);
    const Decoded decoded = Decode(Encode(clip, settings).bytes);
    ASSERT_EQ(decoded.frames.size(), clip.frames.size()) << which;
    EXPECT_EQ(Gap(mesh, decoded), 0) << which;
    for (std::size_t f = 0; which == 2 && f < clip.frames.size(); ++f) {
      const Positions positions = Ordered(decoded.frames[f].positions, decoded.order);
      for (std::size_t v = 0; v < kVertices; ++v) {
        double square = 0;
        for (std::size_t c = 0; c < 3; ++c) square += std::pow(double{positions[v][c]} - clip.frames[f][v][c], 2);
        EXPECT_LE(std::sqrt(square), 0.001);
      }
    }
  }
}

TEST(JoinedVertices, LoosePointsAndSliversStayAsTheyAre) {
  Mesh mesh = SplitCube();
  mesh.colors.clear();
  // Two points and a vertex at one place, a sliver between two vertices at one place, and a vertex of slivers alone.
  mesh.positions.insert(mesh.positions.end(), {mesh.positions[0], mesh.positions[0], mesh.positions[5]});
  mesh.normals.insert(mesh.normals.end(), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  mesh.uvs.clear();
  mesh.uv_triangles.clear();
  std::uint32_t twin = 1;
  while (mesh.positions[twin] != mesh.positions[0]) ++twin;
  mesh.triangles.push_back({0, twin, 3});
  mesh.triangles.push_back({5, 26, 7});
  const Encoded encoded = Encode(Waving(mesh), Joining());
  EXPECT_EQ(HeaderOf(encoded.bytes).vertices, kPlaces + 3);
  const Decoded decoded = Decode(encoded.bytes);
  ASSERT_TRUE(decoded.status.ok()) << decoded.status.message();
  EXPECT_EQ(Turned(decoded.mesh.triangles, decoded.order), Turned(mesh.triangles, Same(mesh.positions.size())));
  for (std::size_t i = 0; i < decoded.order.size(); ++i) {
    if (decoded.order[i] != 24 && decoded.order[i] != 25) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(decoded.mesh.normals[i][c], mesh.normals[decoded.order[i]][c]) << "a point keeps its normal";
    }
  }
}

TEST(JoinedVertices, ThatPartAreRefusedAndTheEncoderGoesOn) {
  const Clip clip = Waving(SplitCube());
  std::unique_ptr<Encoder> encoder;
  ASSERT_TRUE(Encoder::Create(clip.mesh, Joining(), encoder).ok());
  ASSERT_TRUE(encoder->Send(clip.frames[0]).ok());
  Positions torn = clip.frames[1];
  std::uint32_t twin = 1;
  while (clip.mesh.positions[twin] != clip.mesh.positions[0]) ++twin;
  torn[twin][1] += 1e-3f;
  const Status status = encoder->Send(torn);
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.message().find("frame 1, vertex "), std::string::npos) << status.message();
  EXPECT_NE(status.message().find("parts from vertex 0"), std::string::npos) << status.message();
  EXPECT_TRUE(encoder->Send(clip.frames[1]).ok());
  EXPECT_TRUE(encoder->Finish().ok());
  EXPECT_EQ(encoder->frames(), 2u);
}

TEST(JoinedVertices, GivenOnesAreChecked) {
  const Clip clip = Waving(SplitCube());
  std::unique_ptr<Encoder> encoder;
  std::vector<std::uint32_t> lowest = Same(kVertices);
  lowest[3] = 5;
  EXPECT_EQ(Encoder::Create(clip.mesh, {}, encoder, lowest).code(), StatusCode::kInvalidArgument);
  lowest[3] = 2;
  lowest[2] = 1;
  EXPECT_EQ(Encoder::Create(clip.mesh, {}, encoder, lowest).code(), StatusCode::kInvalidArgument);
  lowest.pop_back();
  EXPECT_EQ(Encoder::Create(clip.mesh, {}, encoder, lowest).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(encoder, nullptr);
}

TEST(JoinedVertices, FollowTheSameHandles) {
  Clip clip = Waving(SplitCube());
  EncoderSettings settings = Joining();
  settings.detail_step = 0;
  const Encoded encoded = Encode(clip, settings);
  const Decoded decoded = Decode(encoded.bytes);
  Decoder decoder;
  BlendWeights weights;
  FrameInfo info;
  bool exact = false;
  std::vector<float> matrices;
  std::size_t frames = 0;
  for (std::span<const std::uint8_t> rest(encoded.bytes); !rest.empty();) {
    ASSERT_TRUE(decoder.Send(rest).ok());
    if (!decoder.mesh()) continue;
    ASSERT_TRUE(decoder.Blend(weights).ok());
    ASSERT_EQ(weights.first.size(), kVertices + 1);
    matrices.resize(12 * weights.handle_count);
    for (; decoder.ReceiveHandles(matrices, info, exact).ok(); ++frames) {
      for (std::size_t v = 0; v < kVertices; ++v) {
        Vec3f at = {};
        for (std::uint32_t i = weights.first[v]; i < weights.first[v + 1]; ++i) {
          const float* m = matrices.data() + 12 * weights.handles[i];
          const Vec3f& p = decoder.mesh()->positions[v];
          for (std::size_t r = 0; r < 3; ++r) {
            at[r] += weights.weights[i] * (m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3]);
          }
        }
        for (std::size_t r = 0; r < 3; ++r) EXPECT_NEAR(at[r], decoded.frames.at(frames).positions[v][r], 1e-5);
      }
    }
  }
  EXPECT_EQ(frames, clip.frames.size());
}

TEST(JoinedVertices, AreWrittenToBuffersWithNormalsOfTheirOwn) {
  const Mesh mesh = SplitCube();
  const Encoded encoded = Encode(Waving(mesh), Joining());
  Decoder decoder;
  std::vector<float> positions(3 * kVertices), normals(3 * kVertices), few(3 * kPlaces);
  FrameInfo info;
  std::size_t frames = 0;
  for (std::span<const std::uint8_t> rest(encoded.bytes); !rest.empty();) {
    ASSERT_TRUE(decoder.Send(rest).ok());
    if (!decoder.mesh()) continue;
    EXPECT_EQ(decoder.info()->vertices, kVertices);
    FrameBuffers small;
    small.positions = {few.data(), few.size() * sizeof(float), 12, VertexFormat::kFloat32};
    EXPECT_EQ(decoder.Receive(small, info).code(), StatusCode::kInvalidArgument);
    FrameBuffers buffers;
    buffers.positions = {positions.data(), positions.size() * sizeof(float), 12, VertexFormat::kFloat32};
    buffers.normals = {normals.data(), normals.size() * sizeof(float), 12, VertexFormat::kFloat32};
    for (; decoder.Receive(buffers, info).ok(); ++frames) {
      if (frames > 0) continue;  // frame 0 is the cube, nearly
      for (std::size_t v = 0; v < kVertices; ++v) {
        const Vec3f& wanted = mesh.normals[encoded.order[v]];
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(normals[3 * v + c], wanted[c], 0.2);
      }
    }
  }
  EXPECT_EQ(frames, 6u);
}

TEST(JoinedVertices, AreInAStartThatIsReadAgain) {
  const Clip clip = Waving(SplitCube());
  EncodedStart start, read;
  ASSERT_TRUE(EncodeStart(clip.mesh, Joining(), start).ok());
  const std::vector<std::uint8_t> bytes = WriteStreamStart(start);
  const Status status = ReadStreamStart(bytes, {}, read);
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(read.order, start.order);
  EXPECT_EQ(read.shape.vertex_of_copy, start.shape.vertex_of_copy);
  std::vector<std::vector<std::uint8_t>> streams;
  for (EncodedStart* s : {&start, &read}) {
    StreamEncoder encoder(std::move(*s), Joining());
    for (const Positions& frame : clip.frames) ASSERT_TRUE(encoder.Send(frame).ok());
    ASSERT_TRUE(encoder.Finish().ok());
    streams.push_back(encoder.TakeBytes());
  }
  EXPECT_EQ(streams[0], streams[1]);
  EXPECT_EQ(streams[0], Encode(clip, Joining()).bytes);
}

}  // namespace
}  // namespace sac

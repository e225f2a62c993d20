// SPDX-License-Identifier: Apache-2.0
#include "sac/encoder.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include "tests/test_clips.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Status Create(const Mesh& mesh, const EncoderSettings& settings = {}) {
  std::unique_ptr<Encoder> encoder;
  Status status = Encoder::Create(mesh, settings, encoder);
  EXPECT_EQ(status.ok(), encoder != nullptr);
  EXPECT_EQ(status.ok(), status.message().empty());
  return status;
}

TEST(Encoder, SettingsOutOfRangeAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const std::map<std::string, std::function<void(EncoderSettings&)>> breaks = {
      {"quality below", [](auto& s) { s.quality = -0.1; }},
      {"quality above", [](auto& s) { s.quality = 100.1; }},
      {"quality not a number", [=](auto& s) { s.quality = nan; }},
      {"no harmonics", [](auto& s) { s.harmonics = 0; }},
      {"no group", [](auto& s) { s.group = 0; }},
      {"a huge group", [](auto& s) { s.group = 4097; }},
      {"no pyramid", [](auto& s) { s.pyramid = 0; }},
      {"shrinking steps", [](auto& s) { s.level_growth = 0.99; }},
      {"exploding steps", [](auto& s) { s.level_growth = 2.01; }},
      {"growth not a number", [=](auto& s) { s.level_growth = nan; }},
      {"motion step", [](auto& s) { s.motion_step = 0.0; }},
      {"motion step infinite", [=](auto& s) { s.motion_step = infinity; }},
      {"displacement step", [](auto& s) { s.displacement_step = -1.0; }},
      {"displacement step not a number", [=](auto& s) { s.displacement_step = nan; }},
      {"detail step", [](auto& s) { s.detail_step = -1e-9; }},
      {"detail step not a number", [=](auto& s) { s.detail_step = nan; }},
      {"no error at all", [](auto& s) { s.max_error = 0.0; }},
      {"errors without bound", [=](auto& s) { s.max_error = infinity; }},
      {"errors below the precision of floats", [](auto& s) { s.max_error = 1e-8; }},
      {"no position bits", [](auto& s) { s.position_bits = 0; }},
      {"position bits", [](auto& s) { s.position_bits = 25; }},
      {"frame rate", [](auto& s) { s.frame_rate_denominator = 0; }},
  };
  const Mesh mesh = SphereMesh(1);
  ASSERT_TRUE(Create(mesh).ok());
  for (const auto& [rule, apply] : breaks) {
    EncoderSettings settings;
    apply(settings);
    EXPECT_EQ(Create(mesh, settings).code(), StatusCode::kInvalidArgument) << rule;
  }
}

TEST(Encoder, MalformedMeshesAreRefused) {
  const std::map<std::string, std::function<void(Mesh&)>> breaks = {
      {"no vertices", [](auto& m) { m = {}; }},
      {"a missing vertex", [](auto& m) { m.triangles[3][1] = 12; }},
      {"not a number", [](auto& m) { m.positions[5][1] = kNan; }},
      {"infinite", [](auto& m) { m.positions[0][2] = -kInfinity; }},
      {"normals for some", [](auto& m) { m.normals.resize(11); }},
      {"colours for some", [](auto& m) { m.colors.resize(13); }},
      {"texture for some", [](auto& m) { m.uvs.resize(1), m.uv_triangles.resize(19); }},
      {"a missing texture coordinate",
       [](auto& m) {
         m.uvs.resize(1), m.uv_triangles.resize(20, {0, 0, 1});
       }},
      {"texture too large",
       [](auto& m) {
         m.uvs = {{0, 0}, {3e38f, 0}, {-3e38f, 1}}, m.uv_triangles.resize(20, {0, 1, 2});
       }},
      {"texture not a number",
       [](auto& m) {
         m.uvs = {{0, kNan}}, m.uv_triangles.resize(20, {0, 0, 0});
       }},
      {"normals not numbers",
       [](auto& m) {
         m.normals.resize(12, {0, kNan, 1});
       }},
      {"too large",
       [](auto& m) {
         m.positions[0] = {3e38f, 0, 0}, m.positions[1] = {-3e38f, 0, 0};
       }},
  };
  for (const auto& [rule, apply] : breaks) {
    Mesh mesh = SphereMesh(1);
    apply(mesh);
    EXPECT_EQ(Create(mesh).code(), StatusCode::kInvalidArgument) << rule;
  }
}

TEST(Encoder, GoesOnAfterAFrameThatCannotBe) {
  const Clip clip = BendingClip(9);
  EncoderSettings settings;
  settings.group = 4;
  std::unique_ptr<Encoder> encoder;
  ASSERT_TRUE(Encoder::Create(clip.mesh, settings, encoder).ok());
  std::vector<std::uint8_t> bytes;
  for (const Positions& frame : clip.frames) {
    Positions bad = frame;
    bad[7][0] = kNan;
    EXPECT_EQ(encoder->Send(bad).code(), StatusCode::kInvalidArgument);
    bad[7][0] = kInfinity;
    EXPECT_EQ(encoder->Send(bad).code(), StatusCode::kInvalidArgument);
    bad.pop_back();
    EXPECT_EQ(encoder->Send(bad).code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(encoder->Send({}).code(), StatusCode::kInvalidArgument);
    EXPECT_TRUE(encoder->Send(frame).ok());
  }
  EXPECT_TRUE(encoder->Finish().ok());
  EXPECT_EQ(encoder->TakeBytes(), Encode(clip, settings).bytes);
  EXPECT_TRUE(encoder->TakeBytes().empty());
}

TEST(Encoder, KeepsToTheLimitsOfDecoders) {
  Clip clip;
  clip.mesh = SphereMesh(7);  // 492 vertices
  clip.frames.assign(3, clip.mesh.positions);
  EncoderSettings settings;
  settings.quality = 50;
  std::unique_ptr<Encoder> encoder;
  ASSERT_TRUE(Encoder::Create(clip.mesh, settings, encoder).ok());
  const std::uint32_t usual = encoder->info().harmonics;
  settings.limits.expert.free_work = 2e8;  // too little for so many
  settings.limits.expert.work_per_byte = 0;
  ASSERT_TRUE(Encoder::Create(clip.mesh, settings, encoder).ok());
  EXPECT_LT(encoder->info().harmonics, usual);
  DecoderSettings decoder;
  decoder.limits = settings.limits;
  EXPECT_TRUE(Decode(Encode(clip, settings).bytes, 1000, decoder).status.ok());
  settings.harmonics = usual;
  EXPECT_EQ(Encoder::Create(clip.mesh, settings, encoder).code(), StatusCode::kLimit);
  settings.harmonics.reset();
  settings.limits.vertices = 10;
  EXPECT_EQ(Encoder::Create(clip.mesh, settings, encoder).code(), StatusCode::kLimit);
}

TEST(Encoder, IsFinishedOnce) {
  const Clip clip = BendingClip(1);
  std::unique_ptr<Encoder> encoder;
  ASSERT_TRUE(Encoder::Create(clip.mesh, {}, encoder).ok());
  EXPECT_TRUE(encoder->Finish().ok());
  EXPECT_EQ(encoder->Finish().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(encoder->Send(clip.frames[0]).code(), StatusCode::kInvalidArgument);
}

TEST(Encoder, IsDeterministic) {
  const Clip clip = TurningPartsClip(10);
  EXPECT_EQ(Encode(clip, {}).bytes, Encode(clip, {}).bytes);
}

// Bytes and errors do not depend on the unit of length.
TEST(Encoder, TakesCoordinatesOfEverySize) {
  for (const double scale : {1e-25, 1e-6, 1e6, 1e25}) {
    SCOPED_TRACE(scale);
    Clip clip = BendingClip(10);
    for (Positions& frame : clip.frames) frame = Moved(frame, scale * Eigen::Matrix3d::Identity(), {0, 0, 0});
    clip.mesh.positions = clip.frames[0];
    const Encoded encoded = Encode(clip, {});
    const Decoded decoded = Decode(encoded.bytes);
    ASSERT_EQ(decoded.frames.size(), 10u) << decoded.status.message();
    for (std::size_t t = 0; t < 10; ++t) {
      EXPECT_LT(RmsError(clip.frames[t], decoded.frames[t].positions, encoded.order),
                0.02 * RmsRadius(clip.mesh.positions));
    }
  }
}

TEST(Encoder, TakesShapesFarFromTheOrigin) {
  Clip clip = BendingClip(10);
  for (Positions& frame : clip.frames) frame = Moved(frame, Eigen::Matrix3d::Identity(), {1e6, -1e6, 1e6});
  clip.mesh.positions = clip.frames[0];
  const Encoded encoded = Encode(clip, {});
  const Decoded decoded = Decode(encoded.bytes);
  ASSERT_EQ(decoded.frames.size(), 10u) << decoded.status.message();
  for (std::size_t t = 0; t < 10; ++t) {
    EXPECT_LT(MaxError(clip.frames[t], decoded.frames[t].positions, encoded.order), 0.2);  // floats are 1/16 apart
  }
}

TEST(Encoder, TakesShapesWithoutExtent) {
  for (const std::size_t vertices : {1u, 5u}) {
    Clip clip;
    clip.mesh.positions.assign(vertices, {1, 2, 3});
    if (vertices > 2) clip.mesh.triangles = {{0, 1, 2}, {2, 3, 4}};
    clip.frames.assign(3, clip.mesh.positions);
    const Encoded encoded = Encode(clip, {});
    const Decoded decoded = Decode(encoded.bytes);
    ASSERT_EQ(decoded.frames.size(), 3u) << decoded.status.message();
    for (const DecodedFrame& frame : decoded.frames) EXPECT_EQ(frame.positions, clip.mesh.positions);
  }
}

// What comes out of a point is as near as what comes out of anything.
TEST(Encoder, TakesFirstFramesThatAreAPoint) {
  for (const Vec3f& point : {Vec3f{0, 0, 0}, Vec3f{5, 6, 7}, Vec3f{-1e-3f, 0, 0}}) {
    for (const bool bounded : {false, true}) {
      Clip clip = BendingClip(8);
      const double scale = point[0] == 5 ? 1 : point[0] == 0 ? 1 : 1e-3;
      for (Positions& frame : clip.frames) {
        frame = Moved(frame, scale * Eigen::Matrix3d::Identity(), {point[0], point[1], point[2]});
      }
      clip.frames[0].assign(clip.frames[0].size(), point);
      clip.mesh.positions = clip.frames[0];
      EncoderSettings settings;
      if (bounded) settings.max_error = 1e-3 * scale;
      const Encoded encoded = Encode(clip, settings);
      const Decoded decoded = Decode(encoded.bytes);
      ASSERT_EQ(decoded.frames.size(), 8u) << decoded.status.message();
      for (std::size_t t = 0; t < 8; ++t) {
        const double error = MaxDistance(clip.frames[t], decoded.frames[t].positions, encoded.order);
        EXPECT_LE(error, bounded ? *settings.max_error : 2 * scale) << t;
      }
    }
  }
}

TEST(Encoder, HeaderSaysWhatWasAskedFor) {
  EncoderSettings settings;
  settings.frame_rate_numerator = 30000;
  settings.frame_rate_denominator = 1001;
  settings.position_bits = 13;
  settings.motion_step = 0.125;
  const Encoded encoded = Encode(BendingClip(1), settings);
  Decoder decoder;
  EXPECT_EQ(decoder.info(), nullptr);
  EXPECT_EQ(decoder.mesh(), nullptr);
  for (std::span<const std::uint8_t> rest(encoded.bytes); !rest.empty();) {
    ASSERT_TRUE(decoder.Send(rest).ok());
    DecodedFrame frame;
    while (decoder.Receive(frame).ok()) {
    }
  }
  ASSERT_NE(decoder.info(), nullptr);
  EXPECT_EQ(decoder.info()->frame_rate_numerator, 30000u);
  EXPECT_EQ(decoder.info()->frame_rate_denominator, 1001u);
  SequenceHeader header;
  ASSERT_TRUE(ParseSequenceHeader(Packets(encoded.bytes).front().payload, Limits{}, header).ok());
  EXPECT_EQ(header.position_bits, 13 + 5);  // the grid is finer than the steps
  EXPECT_EQ(decoder.info()->motion_step, 0.125f);
  EXPECT_EQ(decoder.info()->vertices, 80u);
}

}  // namespace
}  // namespace sac

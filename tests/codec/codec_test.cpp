// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>
#include <optional>
#include <random>

#include "format/packet.h"
#include "tests/test_clips.h"

namespace sac {
namespace {

constexpr double kStep = 1e-3;  // of displacements, as a fraction of the RMS radius

// Harmonics enough for every detail, so that only quantization is left.
EncoderSettings Complete(const Clip& clip, double step = kStep) {
  EncoderSettings s;
  s.harmonics = static_cast<std::uint32_t>(4 * clip.mesh.positions.size());
  s.handles_per_harmonic = 0;
  s.level_growth = 1;
  s.displacement_step = step;
  s.motion_step = 30 * step;
  s.position_bits = 12;
  return s;
}

// With n harmonics of unit mean square, each off by up to 0.65 of a step in three coordinates; twice that, because mean
// squares weigh vertices by their area.
double Bound(const Clip& clip, double step) {
  const auto n = static_cast<double>(clip.mesh.positions.size());
  return 2 * 0.65 * step * RmsRadius(clip.mesh.positions) * std::sqrt(3 * n);
}

void ExpectWithin(const Clip& clip, const Encoded& encoded, double bound) {
  const Decoded decoded = Decode(encoded.bytes);
  ASSERT_TRUE(decoded.status.ok()) << decoded.status.message();
  ASSERT_EQ(decoded.frames.size(), clip.frames.size());
  for (std::size_t t = 0; t < clip.frames.size(); ++t) {
    EXPECT_EQ(decoded.frames[t].index, t);
    EXPECT_LT(RmsError(clip.frames[t], decoded.frames[t].positions, encoded.order), bound) << "frame " << t;
  }
}

TEST(Codec, ErrorsFollowTheSteps) {
  for (const Clip& clip : {BendingClip(20), TurningPartsClip(20)}) {
    for (const double step : {1e-2, 1e-3, 1e-4})
      ExpectWithin(clip, Encode(clip, Complete(clip, step)), Bound(clip, step));
  }
}

TEST(Codec, ErrorsFollowTheStepsWithoutBFrames) {
  for (const ReferenceShape reference : {ReferenceShape::kKey, ReferenceShape::kPrevious}) {
    for (const Clip& clip : {BendingClip(20), TurningPartsClip(20)}) {
      EncoderSettings settings = Complete(clip);
      settings.pyramid = 1;
      settings.reference_shape = reference;
      ExpectWithin(clip, Encode(clip, settings), Bound(clip, kStep));
    }
  }
}

TEST(Codec, LevelsOfAPyramidMayBeCoarser) {
  const Clip clip = BendingClip(33);
  EncoderSettings settings = Complete(clip);
  settings.level_growth = 1.5;
  const Encoded coarse = Encode(clip, settings);
  ExpectWithin(clip, coarse, std::pow(1.5, 4) * Bound(clip, kStep));
  EXPECT_LT(coarse.bytes.size(), Encode(clip, Complete(clip)).bytes.size());
}

// A tube whose skin shivers: nothing that a few harmonics could follow.
Clip ShiveringClip(std::size_t frames) {
  Clip clip = BendingClip(frames);
  std::mt19937 random(1);
  for (std::size_t t = 1; t < frames; ++t) {
    for (Vec3f& p : clip.frames[t]) {
      for (float& x : p) x += static_cast<float>(0.05 * Signed(random));
    }
  }
  return clip;
}

TEST(Codec, DetailFollowsItsStep) {
  const Clip clip = ShiveringClip(10);
  EncoderSettings settings;
  settings.harmonics = 10;
  settings.level_growth = 1;
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    settings.detail_step = step;
    ExpectWithin(clip, Encode(clip, settings), Bound(clip, step));
  }
}

TEST(Codec, NoVertexIsFartherOffThanAllowed) {
  for (const double bound : {0.1, 1e-2, 1e-3, 1e-5}) {
    for (const ReferenceShape reference : {ReferenceShape::kKey, ReferenceShape::kPrevious}) {
      EncoderSettings settings;
      settings.max_error = bound;
      settings.reference_shape = reference;
      settings.group = 4;
      if (reference == ReferenceShape::kPrevious) settings.pyramid = 1;
      for (const Clip& clip : {ShiveringClip(6), TurningPartsClip(6)}) {
        const Encoded encoded = Encode(clip, settings);
        const Decoded decoded = Decode(encoded.bytes);
        ASSERT_EQ(decoded.frames.size(), 6u) << decoded.status.message();
        for (std::size_t t = 0; t < 6; ++t) {
          EXPECT_LE(MaxDistance(clip.frames[t], decoded.frames[t].positions, encoded.order), bound) << t;
        }
      }
    }
  }
}

TEST(Codec, DefaultsAreClose) {
  for (const Clip& clip : {BendingClip(40), TurningPartsClip(40)}) {
    ExpectWithin(clip, Encode(clip, {}), 0.02 * RmsRadius(clip.mesh.positions));
  }
}

TEST(Codec, MoreQualityIsNearerAndLonger) {
  const Clip clip = BendingClip(20);
  double last_error = 1e9;
  std::size_t last_size = 0;
  for (const double quality : {0.0, 50.0, 100.0}) {
    EncoderSettings settings;
    settings.quality = quality;
    const Encoded encoded = Encode(clip, settings);
    const Decoded decoded = Decode(encoded.bytes);
    ASSERT_EQ(decoded.frames.size(), 20u);
    double error = 0;
    for (std::size_t t = 0; t < 20; ++t) {
      error += RmsError(clip.frames[t], decoded.frames[t].positions, encoded.order);
    }
    EXPECT_LT(error, last_error);
    EXPECT_GT(encoded.bytes.size(), last_size);
    last_error = error;
    last_size = encoded.bytes.size();
  }
}

TEST(Codec, EveryChunkingGivesTheSameFrames) {
  for (const ReferenceShape reference : {ReferenceShape::kKey, ReferenceShape::kPrevious}) {
    const Clip clip = TurningPartsClip(12);
    EncoderSettings settings;
    settings.group = 5;
    settings.reference_shape = reference;
    if (reference == ReferenceShape::kPrevious) settings.pyramid = 1;
    const Encoded encoded = Encode(clip, settings);
    const Decoded whole = Decode(encoded.bytes);
    ASSERT_TRUE(whole.status.ok());
    ASSERT_EQ(whole.frames.size(), 12u);
    for (const std::size_t chunk : {1u, 7u, 4096u}) {
      const Decoded other = Decode(encoded.bytes, chunk);
      EXPECT_TRUE(other.status.ok());
      ASSERT_EQ(other.frames.size(), whole.frames.size());
      EXPECT_EQ(other.mesh.triangles, whole.mesh.triangles);
      EXPECT_EQ(other.mesh.positions, whole.mesh.positions);
      for (std::size_t t = 0; t < 12; ++t) EXPECT_EQ(other.frames[t].positions, whole.frames[t].positions) << t;
    }
  }
}

TEST(Codec, WhatStandsStillDoesSoExactlyAndCostsNothing) {
  for (const std::uint32_t pyramid : {1u, 16u}) {
    // Still in another pose than the first frame's, so that all coefficients are busy.
    Clip clip{TubeMesh(10, 8), {}};
    clip.frames = {clip.mesh.positions, BentTube(clip.mesh, 1)};
    EncoderSettings settings = Complete(clip);
    settings.pyramid = pyramid;
    const std::size_t two = Encode(clip, settings).bytes.size();
    clip.frames.resize(120, clip.frames[1]);
    const Encoded encoded = Encode(clip, settings);
    EXPECT_LT(encoded.bytes.size(), two + 20);
    ExpectWithin(clip, encoded, Bound(clip, kStep));
    const Decoded decoded = Decode(encoded.bytes);
    ASSERT_EQ(decoded.frames.size(), 120u);
    for (std::size_t t = 2; t < 120; ++t) EXPECT_EQ(decoded.frames[t].positions, decoded.frames[1].positions) << t;
  }
}

TEST(Codec, RigidMotionIsCheap) {
  for (const std::uint32_t pyramid : {1u, 16u}) {
    Clip clip{TubeMesh(10, 8), {}};
    clip.frames.assign(1, clip.mesh.positions);
    EncoderSettings settings;
    settings.pyramid = pyramid;
    settings.displacement_step = kStep;
    const std::size_t one = Encode(clip, settings).bytes.size();
    for (int t = 1; t <= 64; ++t) {
      clip.frames.push_back(Moved(clip.mesh.positions, AxisAngle({1, 2, 3}, 0.11 * t), {0.2 * t, 0.03 * t * t, 0}));
    }
    const Encoded encoded = Encode(clip, settings);
    EXPECT_LT(8.0 * static_cast<double>(encoded.bytes.size() - one) / 64, 100) << "bits a frame";
    ExpectWithin(clip, encoded, 10 * kStep * RmsRadius(clip.mesh.positions));
  }
}

TEST(Codec, ACutBecomesAnIntraFrame) {
  Clip clip{TubeMesh(10, 8), {}};  // straight, bent, and straight again
  for (int t = 0; t < 12; ++t) clip.frames.push_back(BentTube(clip.mesh, (t / 4 == 1 ? 2 : 0) + 0.01 * t));
  EncoderSettings settings = Complete(clip);
  settings.pyramid = 1;
  settings.group = 6;  // the second knows the bent shape alone
  const Encoded encoded = Encode(clip, settings);
  const Decoded decoded = Decode(encoded.bytes);
  ASSERT_EQ(decoded.frames.size(), 12u);
  EXPECT_TRUE(decoded.frames[8].intra);
  for (std::size_t t = 1; t < 12; ++t) {
    EXPECT_TRUE(t % 4 == 0 || t == 6 || !decoded.frames[t].intra) << t;
  }
  ExpectWithin(clip, encoded, Bound(clip, kStep));
}

TEST(Codec, ShapesThatComeAgainArePredictedFromLongAgo) {
  // Two ways to bend take turns, none of them twice the same.
  const auto turns = [](std::size_t frames) {
    Clip clip{TubeMesh(10, 8), {}};
    for (std::size_t t = 0; t < frames; ++t) {
      const double angle = t * 7 % 5 < 2 ? 1.5 : -1;
      clip.frames.push_back(BentTube(clip.mesh, angle + 0.002 * std::sin(static_cast<double>(t))));
    }
    return clip;
  };
  for (const std::uint32_t pyramid : {1u, 8u}) {
    EncoderSettings settings = Complete(turns(1));
    settings.pyramid = pyramid;
    const double few = Encode(turns(4), settings).parts.motion;
    const Clip clip = turns(44);
    const Encoded many = Encode(clip, settings);
    EXPECT_LT(many.parts.motion, 2 * few);
    ExpectWithin(clip, many, Bound(clip, kStep));
  }
}

TEST(Codec, GroupsOfEveryLengthComeBack) {
  for (const std::uint32_t group : {1u, 2u, 3u, 7u, 128u}) {
    for (const std::uint32_t pyramid : {1u, 2u, 3u, 16u}) {
      for (const std::size_t frames : {1u, 2u, 7u}) {
        const Clip clip = BendingClip(frames);
        EncoderSettings settings = Complete(clip);
        settings.group = group;
        settings.pyramid = pyramid;
        const Encoded encoded = Encode(clip, settings);
        ExpectWithin(clip, encoded, Bound(clip, kStep));
        const Decoded decoded = Decode(encoded.bytes);
        for (std::size_t t = 0; t < decoded.frames.size(); t += group) EXPECT_TRUE(decoded.frames[t].intra);
      }
    }
  }
}

TEST(Codec, AGroupNeedsNoOther) {
  for (const ReferenceShape reference : {ReferenceShape::kKey, ReferenceShape::kPrevious}) {
    const Clip clip = BendingClip(11);
    EncoderSettings settings = Complete(clip);
    settings.group = 4;
    settings.reference_shape = reference;
    if (reference == ReferenceShape::kPrevious) settings.pyramid = 1;
    const Encoded encoded = Encode(clip, settings);
    const Decoded whole = Decode(encoded.bytes);
    ASSERT_EQ(whole.frames.size(), 11u);

    std::vector<std::uint8_t> last(std::begin(kMagic), std::end(kMagic));
    PacketReader reader{Limits{}};
    std::optional<Packet> packet;
    std::vector<Packet> packets;
    for (std::span<const std::uint8_t> rest(encoded.bytes); !rest.empty();) {
      ASSERT_TRUE(reader.Read(rest, packet).ok());
      if (packet) packets.push_back(*packet);
    }
    std::size_t groups = 0;
    for (const Packet& p : packets) {
      if (p.type == PacketType::kEnd || (p.type == PacketType::kGroup && ++groups < 3)) continue;
      const auto bytes = WritePacket(p.type, p.payload);
      last.insert(last.end(), bytes.begin(), bytes.end());
    }
    DecoderSettings later;
    later.skip_damage = true;
    const Decoded alone = Decode(last, last.size(), later);
    ASSERT_EQ(alone.frames.size(), 3u);
    for (std::size_t t = 0; t < 3; ++t) EXPECT_EQ(alone.frames[t].positions, whole.frames[8 + t].positions) << t;
  }
}

TEST(Codec, BytesAddUp) {
  const Encoded encoded = Encode(TurningPartsClip(20), {});
  const StreamBytes& p = encoded.parts;
  EXPECT_EQ(p.header + p.i_frame + p.motion + p.displacement + p.detail + p.correction + p.side,
            static_cast<double>(encoded.bytes.size()));
}

TEST(Codec, AClipOfNoFramesIsAMesh) {
  Clip clip = BendingClip(0);
  const Decoded decoded = Decode(Encode(clip, {}).bytes);
  EXPECT_TRUE(decoded.status.ok()) << decoded.status.message();
  EXPECT_TRUE(decoded.frames.empty());
  EXPECT_EQ(decoded.mesh.positions.size(), clip.mesh.positions.size());
}

}  // namespace
}  // namespace sac

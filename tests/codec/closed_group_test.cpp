// SPDX-License-Identifier: Apache-2.0
// A closed group is what its own frames make of it, whatever was coded before.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "codec/encode/encoded_start.h"
#include "codec/encode/stream_encoder.h"
#include "format/group.h"
#include "tests/test_clips.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

constexpr std::uint32_t kGroup = 8;

EncoderSettings Small() {
  EncoderSettings settings;
  settings.harmonics = 16;
  settings.group = kGroup;
  settings.pyramid = 4;
  return settings;
}

// A clip of a tube of which one end, less than half of it, is turned on and on about its axis, by `turns` in all.
Clip TwistingClip(std::size_t frames, double turns = 0.8) {
  Clip clip{TubeMesh(40, 12), {}};
  const double length = 0.5 * 39;
  for (std::size_t t = 0; t < frames; ++t) {
    Positions& frame = clip.frames.emplace_back();
    const double angle = 2 * std::numbers::pi * turns * static_cast<double>(t) / static_cast<double>(frames - 1);
    for (const Vec3f& p : clip.mesh.positions) {
      const double share = std::clamp((p[2] / length - 0.5) / 0.3, 0.0, 1.0);
      frame.push_back(ToVec3f(AxisAngle({0, 0, 1}, angle * share) * Eigen::Vector3d(p[0], p[1], p[2])));
    }
  }
  return clip;
}

// The range codes of all groups and layers.
std::vector<Bytes> Codes(const Bytes& stream) {
  std::vector<Bytes> codes;
  for (const Packet& packet : Packets(stream)) {
    GroupSyntax group;
    LayerSyntax layer;
    std::span<const std::uint8_t> code;
    if (packet.type == PacketType::kGroup) {
      EXPECT_TRUE(ParseGroup(packet.payload, group, code).ok());
    } else if (packet.type == PacketType::kLayer) {
      EXPECT_TRUE(ParseLayer(packet.payload, layer, code).ok());
    } else {
      continue;
    }
    codes.emplace_back(code.begin(), code.end());
  }
  return codes;
}

Bytes EncodeFrames(const Bytes& start, std::span<const Positions> frames, const EncoderSettings& settings) {
  EncodedStart again;
  EXPECT_TRUE(ReadStreamStart(start, {}, again).ok());
  StreamEncoder encoder(std::move(again), settings);
  for (const Positions& frame : frames) EXPECT_TRUE(encoder.Send(frame).ok());
  EXPECT_TRUE(encoder.Finish().ok());
  return encoder.TakeBytes();
}

TEST(ClosedGroup, DependsOnItsFramesAlone) {
  const std::map<std::string, std::function<void(EncoderSettings&)>> kinds = {
      {"smooth", [](auto&) {}},
      {"detail", [](auto& s) { s.quality = 90; }},
      {"bounded", [](auto& s) { s.max_error = 1e-3; }},
      {"layers", [](auto& s) { s.base_levels = 1; }},
      {"previous", [](auto& s) { s.reference_shape = ReferenceShape::kPrevious; }},
  };
  Clip still = BendingClip(4 * kGroup);
  for (std::size_t t = kGroup - 3; t < 3 * kGroup + 2; ++t) still.frames[t] = still.frames[kGroup - 3];
  for (const Clip& clip : {BendingClip(4 * kGroup), TurningPartsClip(4 * kGroup), TwistingClip(4 * kGroup), still}) {
    for (const auto& [kind, apply] : kinds) {
      EncoderSettings settings = Small();
      apply(settings);
      EncodedStart start;
      ASSERT_TRUE(EncodeStart(clip.mesh, settings, start).ok());
      const Bytes written = WriteStreamStart(start);
      const std::vector<Bytes> whole = Codes(EncodeFrames(written, clip.frames, settings));
      std::vector<Bytes> parts;
      for (std::size_t t = 0; t < clip.frames.size(); t += kGroup) {
        const std::span<const Positions> frames = std::span(clip.frames).subspan(t, kGroup);
        for (const Bytes& code : Codes(EncodeFrames(written, frames, settings))) parts.push_back(code);
      }
      EXPECT_EQ(parts, whole) << kind;
    }
  }
}

// Frames stand still across the borders of groups too, exactly, where the group before has two of them or more.
TEST(ClosedGroup, WhatStandsStillGoesOnSoInTheNext) {
  for (const double quality : {40.0, 90.0}) {
    for (const std::uint32_t base_levels : {0u, 1u}) {
      for (const std::size_t first : {kGroup - 2, kGroup - 5, kGroup + 1}) {
        EncoderSettings settings = Small();
        settings.quality = quality;
        settings.base_levels = base_levels;
        Clip clip = BendingClip(4 * kGroup);
        // The pose was there before, from where it must not be taken.
        clip.frames[first - 3] = clip.frames[first];
        for (std::size_t t = first; t < 3 * kGroup + 3; ++t) clip.frames[t] = clip.frames[first];
        const Decoded decoded = Decode(Encode(clip, settings).bytes);
        ASSERT_EQ(decoded.frames.size(), clip.frames.size()) << decoded.status.message();
        for (std::size_t t = first + 1; t < 3 * kGroup + 3; ++t) {
          EXPECT_EQ(decoded.frames[t].positions, decoded.frames[first].positions) << first << ", " << t;
        }
        EXPECT_NE(decoded.frames[first - 1].positions, decoded.frames[first].positions);
      }
    }
  }
}

// A group that begins when the surface is twisted by more than half a turn is as good as one that begins before.
TEST(ClosedGroup, BeginsInTheMiddleOfATwist) {
  const Clip clip = TwistingClip(5 * kGroup);
  EncoderSettings settings = Small();
  settings.harmonics = 40;
  const auto error = [&](std::uint32_t group, std::size_t from) {
    settings.group = group;
    const Encoded encoded = Encode(clip, settings);
    const Decoded decoded = Decode(encoded.bytes);
    EXPECT_EQ(decoded.frames.size(), clip.frames.size());
    double most = 0;
    for (std::size_t t = from; t < decoded.frames.size(); ++t) {
      most = std::max(most, RmsError(clip.frames[t], decoded.frames[t].positions, encoded.order));
    }
    return most;
  };
  const std::size_t half_turn = 26;
  EXPECT_LT(error(kGroup, half_turn), 1.1 * error(5 * kGroup, half_turn));
}

}  // namespace
}  // namespace sac

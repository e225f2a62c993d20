// SPDX-License-Identifier: Apache-2.0
// Groups in layers that can be dropped from the end (spec.md 6.1).
#include <gtest/gtest.h>

#include <cmath>

#include "format/group.h"
#include "format/stream_index.h"
#include "format/thinning.h"
#include "tests/codec/sought_clips.h"
#include "tests/test_clips.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

EncoderSettings Layered(std::uint32_t base_levels = 1) {
  EncoderSettings settings = Grouped(9);
  settings.pyramid = 8;
  settings.base_levels = base_levels;
  settings.detail_step = 0.002;
  settings.max_error = 0.002;
  return settings;
}

Bytes Thinned(const Bytes& stream, std::uint32_t layers, std::size_t chunk = 1000) {
  StreamThinner thinner(layers);
  Bytes out;
  for (std::size_t i = 0; i < stream.size(); i += chunk) {
    const auto part = std::span(stream).subspan(i, std::min(chunk, stream.size() - i));
    EXPECT_TRUE(thinner.Take(part, out).ok());
  }
  EXPECT_TRUE(thinner.Finish().ok());
  return out;
}

double RmsError(const std::vector<DecodedFrame>& frames, const std::vector<DecodedFrame>& exact) {
  double sum = 0, count = 0;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    for (std::size_t v = 0; v < frames[t].positions.size(); ++v) {
      for (std::size_t a = 0; a < 3; ++a) {
        const double e = static_cast<double>(frames[t].positions[v][a]) - static_cast<double>(exact[t].positions[v][a]);
        sum += e * e;
        ++count;
      }
    }
  }
  return std::sqrt(sum / count);
}

TEST(Layers, HoldTheSameFramesAsOneCode) {
  const Clip clip = BendingClip(kFrames);
  EncoderSettings plain = Layered();
  plain.base_levels = 0;
  const Decoded whole = Decode(Encode(clip, plain).bytes);
  for (const std::uint32_t base_levels : {1u, 2u, 4u, 30u}) {
    const Decoded got = Decode(Encode(clip, Layered(base_levels)).bytes, 100);
    ASSERT_TRUE(got.status.ok()) << got.status.message();
    ASSERT_EQ(got.frames.size(), kFrames);
    EXPECT_LT(RmsError(got.frames, whole.frames), 1e-3) << base_levels;
  }
}

TEST(Layers, EveryPrefixIsACoarserStream) {
  const Bytes stream = Encode(BendingClip(kFrames), Layered()).bytes;
  const Decoded whole = Decode(stream);
  double before = 1e9;
  std::size_t bytes = 0;
  for (std::uint32_t layers = 1; layers <= 7; ++layers) {
    const Bytes thin = Thinned(stream, layers);
    EXPECT_GE(thin.size(), bytes);
    bytes = thin.size();
    const Decoded got = Decode(thin);
    ASSERT_TRUE(got.status.ok()) << got.status.message();
    ASSERT_EQ(got.frames.size(), kFrames);
    const double error = RmsError(got.frames, whole.frames);
    EXPECT_LE(error, before * 1.05) << layers;
    before = error;
    // A decoder that wants only these layers shows the same.
    DecoderSettings settings;
    settings.layers = layers;
    const Decoded wanted = Decode(stream, 64, settings);
    ASSERT_TRUE(wanted.status.ok());
    ASSERT_EQ(wanted.frames.size(), kFrames);
    for (std::uint32_t t = 0; t < kFrames; ++t) EXPECT_EQ(wanted.frames[t].positions, got.frames[t].positions);
  }
  EXPECT_EQ(bytes, stream.size());
  EXPECT_EQ(before, 0);
}

TEST(Layers, DecodersTellHowManyThereAre) {
  const auto layers_of = [](const Bytes& stream) {
    Decoder decoder;
    EXPECT_EQ(decoder.layers(), 0u);
    DecodedFrame frame;
    for (std::span<const std::uint8_t> rest(stream); !rest.empty();) {
      EXPECT_TRUE(decoder.Send(rest).ok());
      while (decoder.Receive(frame).ok()) {
      }
    }
    const std::uint32_t layers = decoder.layers();
    decoder.Reset();
    EXPECT_EQ(decoder.layers(), 0u);
    return layers;
  };
  const Bytes stream = Encode(BendingClip(kFrames), Layered()).bytes;
  const std::uint32_t layers = layers_of(stream);
  EXPECT_GE(layers, 3u);
  EXPECT_EQ(Thinned(stream, layers), stream);
  EXPECT_LT(Thinned(stream, layers - 1).size(), stream.size());
  EXPECT_EQ(layers_of(Thinned(stream, 1)), layers);
  EXPECT_EQ(layers_of(Encode(BendingClip(kFrames), {}).bytes), 1u);
}

TEST(Layers, ThinningKeepsTheIndexTrue) {
  const Bytes stream = Encode(BendingClip(kFrames), Layered()).bytes;
  for (std::uint32_t layers = 1; layers <= 7; ++layers) {
    const Bytes thin = Thinned(stream, layers, 7);
    EXPECT_EQ(Thinned(thin, layers), thin);
    const Decoded whole = Decode(thin);
    Decoder decoder;
    std::span<const std::uint8_t> head(thin);
    while (decoder.mesh() == nullptr) ASSERT_TRUE(decoder.Send(head).ok());
    std::size_t needed = 0;
    EXPECT_EQ(decoder.AddIndex(std::span(thin).last(8), needed).code(), StatusCode::kNeedMoreData);
    ASSERT_TRUE(decoder.AddIndex(std::span(thin).last(needed), needed).ok());
    for (const std::uint32_t frame : {20u, 3u, 12u, 0u}) {
      std::uint64_t byte = 0;
      ASSERT_TRUE(decoder.Seek(frame, byte).ok());
      const std::vector<DecodedFrame> frames = ReadOn(decoder, thin, byte);
      ASSERT_EQ(frames.size(), kFrames - frame);
      for (std::size_t t = 0; t < frames.size(); ++t) {
        EXPECT_LT(RmsError({frames[t]}, {whole.frames[frame + t]}), 1e-6);
      }
    }
  }
}

TEST(Layers, WhatHasComeIsShownOnDemand) {
  const Bytes stream = Encode(BendingClip(9), Layered()).bytes;
  const std::vector<Packet> packets = Packets(stream);
  Decoder decoder;
  Bytes sent{std::begin(kMagic), std::end(kMagic)};
  std::size_t layers = 0;
  for (const Packet& packet : packets) {
    const Bytes bytes = WritePacket(packet.type, packet.payload);
    sent.insert(sent.end(), bytes.begin(), bytes.end());
    layers += packet.type == PacketType::kLayer;
    if (layers == 2) break;
  }
  std::span<const std::uint8_t> rest(sent);
  DecodedFrame frame;
  while (!rest.empty()) ASSERT_TRUE(decoder.Send(rest).ok());
  EXPECT_EQ(decoder.Receive(frame).code(), StatusCode::kNeedMoreData);
  ASSERT_TRUE(decoder.Flush().ok());
  std::vector<DecodedFrame> frames;
  while (decoder.Receive(frame).ok()) frames.push_back(frame);
  const Decoded thin = Decode(Thinned(stream, 3));
  ASSERT_EQ(frames.size(), 9u);
  for (std::size_t t = 0; t < 9; ++t) EXPECT_EQ(frames[t].positions, thin.frames[t].positions);
  // The layers that come late are passed over, and the stream goes on.
  for (rest = std::span(stream).subspan(sent.size()); !rest.empty();) ASSERT_TRUE(decoder.Send(rest).ok());
  EXPECT_TRUE(decoder.Finish().ok());
}

TEST(Layers, DamageCostsTheLayersFromThereOn) {
  const Bytes stream = Encode(BendingClip(kFrames), Layered()).bytes;
  Bytes damaged{std::begin(kMagic), std::end(kMagic)};
  std::size_t layers = 0;
  for (const Packet& packet : Packets(stream)) {
    Bytes bytes = WritePacket(packet.type, packet.payload);
    if (packet.type == PacketType::kLayer && ++layers == 3) bytes.back() ^= 1;  // of the first group
    damaged.insert(damaged.end(), bytes.begin(), bytes.end());
  }
  EXPECT_EQ(Decode(damaged).status.code(), StatusCode::kCorrupt);
  DecoderSettings settings;
  settings.skip_damage = true;
  const Decoded got = Decode(damaged, 50, settings);
  const Decoded thin = Decode(Thinned(stream, 3)), whole = Decode(stream);
  ASSERT_EQ(got.frames.size(), kFrames);
  for (std::uint32_t t = 0; t < kFrames; ++t) {
    EXPECT_EQ(got.frames[t].positions, (t < 9 ? thin : whole).frames[t].positions) << t;
  }
}

TEST(Layers, CostLittle) {
  const Clip clip = BendingClip(64);
  EncoderSettings settings = Grouped(64);
  settings.pyramid = 16;
  const std::size_t plain = Encode(clip, settings).bytes.size();
  settings.base_levels = 1;
  const std::size_t layered = Encode(clip, settings).bytes.size();
  EXPECT_LT(layered, plain + 60);  // some ten bytes a layer
}

TEST(Layers, NeedBFrames) {
  EncoderSettings settings = Layered();
  settings.low_delay = true;
  std::unique_ptr<Encoder> encoder;
  EXPECT_EQ(Encoder::Create(BendingClip(1).mesh, settings, encoder).code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace sac

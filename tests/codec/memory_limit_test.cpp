// SPDX-License-Identifier: Apache-2.0
// What a decoder holds against what it counts beforehand (spec.md 9).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "format/packet.h"
#include "format/stream_index.h"
#include "sac/decoder.h"
#include "sac/encoder.h"
#include "synth/synth.h"
#include "tests/codec/counted_memory.h"

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes Encode(const Mesh& mesh, const std::function<Positions(std::uint32_t)>& frame, std::uint32_t frames,
             const EncoderSettings& settings) {
  std::unique_ptr<Encoder> encoder;
  EXPECT_TRUE(Encoder::Create(mesh, settings, encoder).ok());
  for (std::uint32_t f = 0; f < frames; ++f) EXPECT_TRUE(encoder->Send(frame(f)).ok());
  EXPECT_TRUE(encoder->Finish().ok());
  return encoder->TakeBytes();
}

Bytes Encode(SynthKind kind, std::uint32_t vertices, std::uint32_t frames, const EncoderSettings& settings) {
  SynthSettings synth;
  synth.kind = kind;
  synth.vertices = vertices;
  synth.frames = frames;
  SynthClip clip;
  EXPECT_TRUE(SynthClip::Create(synth, clip).ok());
  return Encode(
      clip.mesh(), [&](std::uint32_t f) { return clip.Frame(f); }, frames, settings);
}

// A chain of triangles whose vertices fill a cube.
Mesh Tangle(std::uint32_t vertices) {
  std::mt19937 random(1);
  Mesh mesh;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    Vec3f& p = mesh.positions.emplace_back();
    for (float& x : p) x = static_cast<float>(random() % 10000);
    if (v >= 2) mesh.triangles.push_back({v - 2, v - 1, v});
  }
  return mesh;
}

// `peak`: bytes that were held at a time.
Status Decode(const Bytes& stream, std::uint64_t limit, std::size_t& peak, DecoderSettings settings = {}) {
  const std::size_t before = counted_memory.bytes;
  counted_memory.peak_bytes = before;
  settings.limits.memory = limit;
  Decoder decoder(settings);
  DecodedFrame frame;
  Status status;
  for (std::span<const std::uint8_t> rest(stream); !rest.empty() && status.ok();) {
    status = decoder.Send(rest);
    if (!status.ok()) break;
    while ((status = decoder.Receive(frame)).ok()) {
    }
    if (status.code() == StatusCode::kNeedMoreData) status = Status::Ok();
  }
  peak = counted_memory.peak_bytes - before;
  return status.ok() ? decoder.Finish() : status;
}

void ExpectCountedAbove(const char* name, const Bytes& stream) {
  SCOPED_TRACE(name);
  std::size_t peak = 0, unused = 0;
  ASSERT_TRUE(Decode(stream, Limits{}.memory, peak).ok());
  std::uint64_t low = 1, high = Limits{}.memory;  // refused, decoded
  while (static_cast<double>(high) > 1.02 * static_cast<double>(low)) {
    const auto middle = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(low) * static_cast<double>(high)));
    const Status status = Decode(stream, middle, unused);
    ASSERT_TRUE(status.ok() || status.code() == StatusCode::kLimit) << status.message();
    (status.ok() ? high : low) = middle;
    EXPECT_LE(unused, peak + 1000) << "a message apart";
  }
  EXPECT_LE(peak, high);
  EXPECT_LE(high, 3 * peak);
}

TEST(MemoryLimit, IsAboutWhatADecoderHolds) {
  EncoderSettings settings;
  settings.harmonics = 100;
  ExpectCountedAbove("reduced", Encode(SynthKind::kWalker, 2500, 8, settings));
  settings.harmonics = 20;
  ExpectCountedAbove("few", Encode(SynthKind::kWalker, 5000, 4, settings));
  settings.harmonics = 60;
  settings.handles_per_harmonic = 0;
  ExpectCountedAbove("exact", Encode(SynthKind::kWalker, 2100, 4, settings));
  settings.harmonics = 400;
  ExpectCountedAbove("dense", Encode(SynthKind::kSphere, 642, 4, settings));
  settings = {};
  settings.harmonics = 50;
  settings.detail_step = 0.01;
  ExpectCountedAbove("detail", Encode(SynthKind::kWalker, 2100, 64, settings));
  settings = {};
  settings.harmonics = 200;
  ExpectCountedAbove("parts", Encode(SynthKind::kParts, 3000, 100, settings));
  ExpectCountedAbove("vase", Encode(SynthKind::kVase, 3000, 100, settings));
  settings.group = 30;
  settings.harmonics = 100;
  ExpectCountedAbove("two groups", Encode(SynthKind::kParts, 1500, 60, settings));
  settings.harmonics = 20;
  settings.handles_per_harmonic = 10;
  const Mesh tangle = Tangle(2000);
  ExpectCountedAbove("volume", Encode(
                                   tangle, [&](std::uint32_t) { return tangle.positions; }, 1, settings));
}

TEST(MemoryLimit, ThreadsTakeWhatIsLeft) {
  EncoderSettings encoding;
  encoding.harmonics = 20;
  const Bytes stream = Encode(SynthKind::kWalker, 3000, 40, encoding);
  DecoderSettings settings;
  settings.threads = 16;
  std::size_t one = 0, all = 0, peak = 0;
  ASSERT_TRUE(Decode(stream, Limits{}.memory, one).ok());
  ASSERT_TRUE(Decode(stream, Limits{}.memory, all, settings).ok());
  EXPECT_GT(all, one);
  for (std::uint64_t limit = Limits{}.memory; Decode(stream, limit, peak, settings).ok(); limit = limit * 3 / 4) {
    EXPECT_LE(peak, limit);
  }
  EXPECT_LT(peak, one);
}

// What is no frame's: packets that never end, and an index without end.
TEST(MemoryLimit, HoldsOfWhatIsSearchedAndOfAnIndex) {
  constexpr std::uint64_t kLimit = 1 << 20;
  Bytes tags(std::begin(kMagic), std::end(kMagic));
  for (int i = 0; i < 1 << 20; ++i) tags.insert(tags.end(), {0xff, 0xff, 0xff, 0x1f});
  DecoderSettings settings;
  settings.skip_damage = true;
  std::size_t peak = 0;
  EXPECT_EQ(Decode(tags, kLimit, peak, settings).code(), StatusCode::kCorrupt);
  EXPECT_LE(peak, 2 * kLimit);

  std::size_t needed = 0;
  StreamIndex index;
  const Bytes payload = WriteEnd({0, StreamIndex{0, {}, std::vector<StreamIndex::Group>(100000)}});
  const Bytes end = WritePacket(PacketType::kEnd, payload);
  EXPECT_TRUE(ReadIndex(end, {}, index, needed).ok());
  Limits limits;
  limits.memory = kLimit;
  EXPECT_EQ(ReadIndex(end, limits, index, needed).code(), StatusCode::kLimit);
  limits = {};
  limits.expert.packet_bytes = 1000;
  EXPECT_EQ(ReadIndex(end, limits, index, needed).code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace sac

// What a decoder holds against what it counts beforehand (spec.md 9).
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/encode/encoder.h"
#include "synth/synth.h"
#include "tests/counted_memory.h"

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes Encode(SynthKind kind, std::uint32_t vertices, std::uint32_t frames, const EncoderSettings& settings) {
  SynthSettings synth;
  synth.kind = kind;
  synth.vertices = vertices;
  synth.frames = frames;
  SynthClip clip;
  EXPECT_TRUE(SynthClip::Create(synth, clip).ok());
  std::unique_ptr<Encoder> encoder;
  EXPECT_TRUE(Encoder::Create(clip.mesh(), settings, encoder).ok());
  for (std::uint32_t f = 0; f < frames; ++f) EXPECT_TRUE(encoder->Send(clip.Frame(f)).ok());
  EXPECT_TRUE(encoder->Finish().ok());
  return encoder->TakeBytes();
}

// `peak`: bytes that were held at a time.
Status Decode(const Bytes& stream, std::uint64_t limit, std::size_t& peak) {
  const std::size_t before = counted_memory.bytes;
  counted_memory.peak_bytes = before;
  DecoderSettings settings;
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
  settings.samples_per_harmonic = 0;
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
}

}  // namespace
}  // namespace sac

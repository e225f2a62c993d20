// SPDX-License-Identifier: Apache-2.0
// A player's loop must not allocate: within a group, frames go to the caller's buffers in memory that the decoder
// holds.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "sac/decoder.h"
#include "sac/encoder.h"
#include "synth/synth.h"
#include "tests/codec/counted_memory.h"

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::uint32_t kGroup = 24;

Bytes Stream(EncoderSettings settings) {
  SynthSettings synth;
  synth.kind = SynthKind::kParts;
  synth.vertices = 900;
  synth.frames = 2 * kGroup;
  SynthClip clip;
  EXPECT_TRUE(SynthClip::Create(synth, clip).ok());
  settings.group = kGroup;
  std::unique_ptr<Encoder> encoder;
  EXPECT_TRUE(Encoder::Create(clip.mesh(), settings, encoder).ok());
  for (std::uint32_t f = 0; f < synth.frames; ++f) EXPECT_TRUE(encoder->Send(clip.Frame(f)).ok());
  EXPECT_TRUE(encoder->Finish().ok());
  return encoder->TakeBytes();
}

// The caller's buffers for positions and normals.
struct Buffers {
  explicit Buffers(std::size_t vertices) : positions(vertices), normals(vertices) {
    frame.positions = {positions.data(), 12 * vertices, 12, VertexFormat::kFloat32};
    frame.normals = {normals.data(), 6 * vertices, 6, VertexFormat::kInt16};
  }
  std::vector<Vec3f> positions;
  std::vector<std::array<std::int16_t, 3>> normals;
  FrameBuffers frame;
};

// Sends bytes until frames of the next group wait.
void SendGroup(Decoder& decoder, std::span<const std::uint8_t>& rest, const FrameBuffers& buffers) {
  FrameInfo info;
  while (decoder.Receive(buffers, info).code() == StatusCode::kNeedMoreData) {
    ASSERT_FALSE(rest.empty());
    ASSERT_TRUE(decoder.Send(rest).ok());
  }
}

// Receives two groups, after `first` frames of the first one without allocations.
void ExpectNoAllocations(const DecoderSettings& settings, const EncoderSettings& coded, std::uint32_t first) {
  const Bytes stream = Stream(coded);
  Decoder decoder(settings);
  std::span<const std::uint8_t> rest(stream);
  while (decoder.mesh() == nullptr) ASSERT_TRUE(decoder.Send(rest).ok());
  Buffers buffers(decoder.mesh()->positions.size());
  for (int group = 0; group < 2; ++group) {
    SendGroup(decoder, rest, buffers.frame);
    FrameInfo info;
    std::uint32_t frames = 1;
    while (group == 0 && frames < first && decoder.Receive(buffers.frame, info).ok()) ++frames;
    const long before = counted_memory.allocations;
    while (decoder.Receive(buffers.frame, info).ok()) ++frames;
    EXPECT_EQ(frames, kGroup);
    EXPECT_EQ(counted_memory.allocations, before) << "group " << group;
  }
}

EncoderSettings Detailed() {
  EncoderSettings settings;
  settings.detail_step = 0.001;
  settings.max_error = 0.01;
  return settings;
}

TEST(SteadyMemory, ReceiveAllocatesNothing) {
  // The second frame is the first that moves.
  ExpectNoAllocations({}, {}, 2);
  ExpectNoAllocations({}, Detailed(), 2);
}

TEST(SteadyMemory, JobsAllocateNothing) {
  DecoderSettings settings;
  settings.threads = 3;
  settings.run_jobs = [](std::size_t jobs, const std::function<void(std::size_t)>& job) {
    for (std::size_t i = 0; i < jobs; ++i) job(i);
  };
  ExpectNoAllocations(settings, Detailed(), 13);  // the first batch has 12
}

TEST(SteadyMemory, InterpolateAllocatesNothing) {
  const Bytes stream = Stream(Detailed());
  Decoder decoder;
  std::span<const std::uint8_t> rest(stream);
  while (decoder.mesh() == nullptr) ASSERT_TRUE(decoder.Send(rest).ok());
  Buffers buffers(decoder.mesh()->positions.size());
  SendGroup(decoder, rest, buffers.frame);
  FrameInfo info;
  ASSERT_TRUE(decoder.Interpolate(1.25, buffers.frame, info).ok());
  const long before = counted_memory.allocations;
  for (double time = 1.5; time < kGroup - 1; time += 0.25) {
    ASSERT_TRUE(decoder.Interpolate(time, buffers.frame, info).ok()) << time;
  }
  EXPECT_EQ(counted_memory.allocations, before);
}

TEST(SteadyMemory, ResetNeedsNoMemory) {
  const Bytes stream = Stream({});
  Decoder decoder;
  std::span<const std::uint8_t> rest(stream);
  while (decoder.mesh() == nullptr) ASSERT_TRUE(decoder.Send(rest).ok());
  counted_memory.until_failure = 0;
  counted_memory.fail_on = true;
  decoder.Reset();
  counted_memory.until_failure = -1;
  counted_memory.fail_on = false;
  EXPECT_EQ(decoder.mesh(), nullptr);
  rest = stream;
  while (decoder.mesh() == nullptr) ASSERT_TRUE(decoder.Send(rest).ok());
}

}  // namespace
}  // namespace sac

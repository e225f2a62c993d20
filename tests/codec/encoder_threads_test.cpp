// SPDX-License-Identifier: Apache-2.0
// Groups are coded at the same time; what comes out does not depend on how many.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <new>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "sac/encoder.h"
#include "sac/sac_encode.h"
#include "tests/test_clips.h"
#include "tests/test_packets.h"

namespace sac {
namespace {

using Job = std::function<void(std::size_t)>;

constexpr std::uint32_t kGroup = 6;

EncoderSettings Small(unsigned threads) {
  EncoderSettings settings;
  settings.harmonics = 12;
  settings.group = kGroup;
  settings.pyramid = 4;
  settings.threads = threads;
  return settings;
}

// What became of a clip that is sent until something fails, and is then finished.
struct Outcome {
  Bytes bytes;
  std::string failure;  // of Send(), or of Finish() where no frame failed before
  std::optional<FrameFault> fault;
  std::uint32_t frames = 0;
};

Outcome SendAll(const Clip& clip, const EncoderSettings& settings) {
  Outcome outcome;
  std::unique_ptr<Encoder> encoder;
  if (Status s = Encoder::Create(clip.mesh, settings, encoder); !s.ok()) return {{}, s.message(), {}, 0};
  Status status;
  for (std::size_t t = 0; t < clip.frames.size() && status.ok(); ++t) status = encoder->Send(clip.frames[t]);
  if (status.ok()) status = encoder->Finish();
  if (!status.ok()) static_cast<void>(encoder->Finish());
  outcome.bytes = encoder->TakeBytes();
  outcome.failure = status.message();
  outcome.fault = encoder->fault();
  outcome.frames = encoder->frames();
  return outcome;
}

TEST(EncoderThreads, BytesAreThoseOfOneThread) {
  const std::map<std::string, std::function<void(EncoderSettings&)>> kinds = {
      {"smooth", [](auto&) {}},
      {"detail", [](auto& s) { s.quality = 90; }},
      {"bounded", [](auto& s) { s.max_error = 1e-3; }},
      {"layers", [](auto& s) { s.base_levels = 1; }},
      {"previous", [](auto& s) { s.reference_shape = ReferenceShape::kPrevious; }},
      {"low delay", [](auto& s) { s.low_delay = true; }},
      {"boxes and starts", [](auto& s) { s.bounds = true, s.repeat_start = 2; }},
  };
  for (const Clip& clip : {BendingClip(5 * kGroup + 2), TurningPartsClip(2 * kGroup)}) {
    for (const auto& [kind, apply] : kinds) {
      EncoderSettings settings = Small(1);
      apply(settings);
      const Bytes bytes = Encode(clip, settings).bytes;
      EXPECT_EQ(Decode(bytes).frames.size(), clip.frames.size()) << kind;
      for (const unsigned threads : {0u, 2u, 3u, 16u}) {
        settings.threads = threads;
        EXPECT_EQ(Encode(clip, settings).bytes, bytes) << kind << ", " << threads;
      }
    }
  }
}

TEST(EncoderThreads, SegmentsFollowEachOther) {
  const Clip first = BendingClip(2 * kGroup + 1), second = TurningPartsClip(kGroup + 1);
  const auto encode = [&](unsigned threads) {
    std::unique_ptr<Encoder> encoder;
    EXPECT_TRUE(Encoder::Create(first.mesh, Small(threads), encoder).ok());
    for (const Positions& frame : first.frames) EXPECT_TRUE(encoder->Send(frame).ok());
    EXPECT_TRUE(encoder->BeginSegment(second.mesh).ok());
    for (const Positions& frame : second.frames) EXPECT_TRUE(encoder->Send(frame).ok());
    EXPECT_TRUE(encoder->Finish().ok());
    return encoder->TakeBytes();
  };
  const Bytes bytes = encode(1);
  EXPECT_EQ(encode(2), bytes);
  EXPECT_EQ(encode(5), bytes);
}

TEST(EncoderThreads, AnEngineRunsTheGroups) {
  const Clip clip = BendingClip(7 * kGroup);
  const Bytes bytes = Encode(clip, Small(1)).bytes;
  std::size_t most = 0;
  const auto in_reverse = [&](std::size_t jobs, const Job& job) {
    most = std::max(most, jobs);
    for (std::size_t i = jobs; i-- > 0;) job(i);
  };
  const auto on_threads = [](std::size_t jobs, const Job& job) {
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < jobs; ++i) threads.emplace_back(job, i);
    for (std::thread& thread : threads) thread.join();
  };
  const auto more = [](std::size_t jobs, const Job& job) {
    for (std::size_t i = 0; i < 2 * jobs + 7; ++i) job(i);
  };
  for (const JobRunner& runner : {JobRunner(in_reverse), JobRunner(on_threads), JobRunner(more)}) {
    EncoderSettings settings = Small(3);
    settings.run_jobs = runner;
    EXPECT_EQ(Encode(clip, settings).bytes, bytes);
  }
  EXPECT_EQ(most, 3u);
}

TEST(EncoderThreads, AnEngineThatFailsIsAnError) {
  const Clip clip = BendingClip(3 * kGroup);
  const auto failure = [&](JobRunner runner) {
    EncoderSettings settings = Small(3);
    settings.run_jobs = std::move(runner);
    return SendAll(clip, settings).failure;
  };
  EXPECT_EQ(failure([](std::size_t, const Job&) {}), "run_jobs has left all jobs out");
  EXPECT_EQ(failure([](std::size_t, const Job&) { throw std::runtime_error("no workers"); }),
            "run_jobs threw an exception");
  EXPECT_EQ(failure([](std::size_t, const Job&) { throw 1; }), "run_jobs threw an exception");
  EXPECT_EQ(failure([](std::size_t, const Job&) { throw std::bad_alloc(); }), "out of memory");
}

// Frames that cannot be coded, and frames that are none, in groups that are coded at the same time.
TEST(EncoderThreads, TheFirstFrameAtFaultIsNamed) {
  for (const std::vector<std::size_t>& torn :
       {std::vector<std::size_t>{2}, {kGroup + 3}, {4 * kGroup + 1, 2 * kGroup + 2}, {3 * kGroup, 3 * kGroup + 1}}) {
    for (const std::size_t bad : {std::size_t{0}, torn[0] + 1, std::size_t{6 * kGroup}}) {
      Clip clip = BendingClip(6 * kGroup + 2);
      std::mt19937 random(1);
      for (const std::size_t t : torn) {
        for (Vec3f& p : clip.frames[t]) p[0] += static_cast<float>(1e5 * Signed(random));
      }
      if (bad > 0) clip.frames[bad][3][1] = std::numeric_limits<float>::quiet_NaN();
      EncoderSettings settings = Small(1);
      settings.max_error = 1e-5;
      const Outcome one = SendAll(clip, settings);
      EXPECT_EQ(one.failure.rfind("frame ", 0), 0u) << one.failure;
      for (const unsigned threads : {2u, 3u, 8u}) {
        settings.threads = threads;
        const Outcome other = SendAll(clip, settings);
        EXPECT_EQ(other.failure, one.failure) << threads;
        EXPECT_EQ(other.bytes, one.bytes) << threads;
        EXPECT_EQ(other.frames, one.frames);
        ASSERT_TRUE(one.fault && other.fault);
        EXPECT_EQ(other.fault->frame, one.fault->frame);
        EXPECT_EQ(other.fault->vertex, one.fault->vertex);
      }
    }
  }
}

TEST(EncoderThreads, ProgressGrowsOnTheCallersThreadAndCancels) {
  const Clip clip = BendingClip(7 * kGroup + 1);
  const std::thread::id here = std::this_thread::get_id();
  for (const unsigned threads : {1u, 2u, 3u}) {
    std::vector<std::uint32_t> told;
    EncoderSettings settings = Small(threads);
    settings.progress = [&](std::uint32_t frames) {
      EXPECT_EQ(std::this_thread::get_id(), here);
      told.push_back(frames);
      return true;
    };
    EXPECT_EQ(SendAll(clip, settings).failure, "");
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_EQ(told.back(), clip.frames.size());
    for (const std::uint32_t last : {1u, kGroup, 3 * kGroup + 1}) {
      std::unique_ptr<Encoder> encoder;
      settings.progress = [last](std::uint32_t frames) { return frames < last; };
      ASSERT_TRUE(Encoder::Create(clip.mesh, settings, encoder).ok());
      Status status;
      for (std::size_t t = 0; t < clip.frames.size() && status.ok(); ++t) status = encoder->Send(clip.frames[t]);
      EXPECT_EQ(status.code(), StatusCode::kCancelled) << threads << ", " << last;
      EXPECT_LE(encoder->frames(), last + threads * kGroup);
      EXPECT_EQ(encoder->Finish().code(), StatusCode::kCancelled);
    }
  }
}

TEST(EncoderThreads, FlushCodesWhatIsFull) {
  const Clip clip = BendingClip(kGroup + 1);
  std::unique_ptr<Encoder> encoder;
  ASSERT_TRUE(Encoder::Create(clip.mesh, Small(4), encoder).ok());
  for (const Positions& frame : clip.frames) ASSERT_TRUE(encoder->Send(frame).ok());
  EXPECT_EQ(encoder->frames(), 0u);
  ASSERT_TRUE(encoder->Flush().ok());
  EXPECT_EQ(encoder->frames(), kGroup);
  ASSERT_TRUE(encoder->Finish().ok());
  EXPECT_EQ(encoder->TakeBytes(), Encode(clip, Small(1)).bytes);
}

TEST(EncoderThreads, ComeThroughTheInterfaceOfC) {
  const Clip clip = BendingClip(4 * kGroup);
  sac_encoder_settings settings;
  sac_encoder_settings_init(&settings);
  EXPECT_EQ(settings.threads, 0u);
  settings.harmonics = 12;
  settings.group = kGroup;
  settings.pyramid = 4;
  settings.threads = 4;
  std::size_t jobs = 0;
  settings.run_jobs_user = &jobs;
  settings.run_jobs = [](void* user, std::size_t count, void (*job)(void* context, std::size_t i), void* context) {
    *static_cast<std::size_t*>(user) += count;
    for (std::size_t i = 0; i < count; ++i) job(context, i);
  };
  sac_input_mesh mesh = {};
  mesh.vertices = static_cast<std::uint32_t>(clip.mesh.positions.size());
  mesh.triangles = static_cast<std::uint32_t>(clip.mesh.triangles.size());
  mesh.positions = clip.mesh.positions[0].data();
  mesh.triangle_vertices = clip.mesh.triangles[0].data();
  sac_encoder* encoder = nullptr;
  ASSERT_EQ(sac_encoder_open(&encoder, &mesh, &settings), SAC_OK) << sac_encoder_message(encoder);
  for (const Positions& frame : clip.frames) ASSERT_EQ(sac_encoder_send(encoder, frame[0].data(), 0), SAC_OK);
  ASSERT_EQ(sac_encoder_finish(encoder), SAC_OK);
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
  ASSERT_EQ(sac_encoder_take(encoder, &data, &size), SAC_OK);
  EXPECT_EQ(Bytes(data, data + size), Encode(clip, Small(1)).bytes);
  EXPECT_EQ(jobs, 4u);
  sac_encoder_close(encoder);
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
// A player's own job system reconstructs frames (DecoderSettings::run_jobs).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <new>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "sac/sac.h"
#include "tests/test_clips.h"

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Job = std::function<void(std::size_t)>;

constexpr std::uint32_t kFrames = 50;

Bytes Stream() {
  EncoderSettings settings;
  settings.harmonics = 20;
  settings.group = 25;
  settings.max_error = 0.02;
  return Encode(BendingClip(kFrames), settings).bytes;
}

DecoderSettings With(JobRunner run_jobs, unsigned threads = 3) {
  DecoderSettings settings;
  settings.threads = threads;
  settings.run_jobs = std::move(run_jobs);
  return settings;
}

void RunInOrder(std::size_t jobs, const Job& job) {
  for (std::size_t i = 0; i < jobs; ++i) job(i);
}

void RunInReverse(std::size_t jobs, const Job& job) {
  for (std::size_t i = jobs; i-- > 0;) job(i);
}

void RunOnThreads(std::size_t jobs, const Job& job) {
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < jobs; ++i) threads.emplace_back(job, i);
  for (std::thread& thread : threads) thread.join();
}

TEST(RunJobs, GivesTheFramesOfThreads) {
  const Bytes stream = Stream();
  const Decoded whole = Decode(stream, stream.size(), With({}));
  ASSERT_TRUE(whole.status.ok()) << whole.status.message();
  ASSERT_EQ(whole.frames.size(), kFrames);
  std::size_t most_jobs = 0, calls = 0;
  const auto counted = [&](std::size_t jobs, const Job& job) {
    most_jobs = std::max(most_jobs, jobs);
    ++calls;
    RunInOrder(jobs, job);
  };
  for (const JobRunner& runner : {JobRunner(counted), JobRunner(RunInReverse), JobRunner(RunOnThreads)}) {
    const Decoded decoded = Decode(stream, stream.size(), With(runner));
    ASSERT_TRUE(decoded.status.ok()) << decoded.status.message();
    ASSERT_EQ(decoded.frames.size(), kFrames);
    for (std::size_t f = 0; f < kFrames; ++f) EXPECT_EQ(decoded.frames[f].positions, whole.frames[f].positions) << f;
  }
  EXPECT_EQ(most_jobs, 3u);
  EXPECT_GT(calls, 3u);
}

TEST(RunJobs, AreNotWantedByOneThread) {
  const Bytes stream = Stream();
  int calls = 0;
  const auto counted = [&](std::size_t jobs, const Job& job) {
    ++calls;
    RunInOrder(jobs, job);
  };
  EXPECT_TRUE(Decode(stream, stream.size(), With(counted, 1)).status.ok());
  EXPECT_EQ(calls, 0);
}

// What a runner does wrong is an error, which skip_damage does not take for damage; nothing is thrown.
TEST(RunJobs, FailuresAreErrors) {
  const Bytes stream = Stream();
  const auto none = [](std::size_t, const Job&) {};
  const auto but_the_last = [](std::size_t jobs, const Job& job) { RunInOrder(jobs - 1, job); };
  const auto throws = [](std::size_t, const Job&) { throw std::runtime_error("no workers"); };
  const auto throws_any = [](std::size_t, const Job&) { throw 1; };
  const auto throws_memory = [](std::size_t, const Job&) { throw std::bad_alloc(); };
  for (const bool skip_damage : {false, true}) {
    const auto code = [&](JobRunner runner) {
      DecoderSettings settings = With(std::move(runner));
      settings.skip_damage = skip_damage;
      return Decode(stream, stream.size(), settings).status.code();
    };
    EXPECT_EQ(code(none), StatusCode::kInvalidArgument);
    EXPECT_EQ(code(but_the_last), StatusCode::kInvalidArgument);
    EXPECT_EQ(code(throws), StatusCode::kInvalidArgument);
    EXPECT_EQ(code(throws_any), StatusCode::kInvalidArgument);
    EXPECT_EQ(code(throws_memory), StatusCode::kLimit);
  }
}

TEST(RunJobs, NumbersThatAreNoneDoNothing) {
  const Bytes stream = Stream();
  const auto more = [](std::size_t jobs, const Job& job) { RunInOrder(2 * jobs + 7, job); };
  EXPECT_TRUE(Decode(stream, stream.size(), With(more)).status.ok());
}

// A job system of C, which counts its jobs.
void CountedRun(void* user, std::size_t jobs, void (*job)(void* context, std::size_t i), void* context) {
  *static_cast<std::size_t*>(user) += jobs;
  for (std::size_t i = 0; i < jobs; ++i) job(context, i);
}

TEST(RunJobs, ComeThroughTheInterfaceOfC) {
  const Bytes stream = Stream();
  std::size_t jobs = 0;
  sac_settings settings;
  sac_settings_init(&settings);
  settings.threads = 4;
  settings.run_jobs = CountedRun;
  settings.run_jobs_user = &jobs;
  sac_decoder* decoder = nullptr;
  ASSERT_EQ(sac_decoder_open(&decoder, &settings), SAC_OK);
  const std::uint8_t* data = stream.data();
  std::size_t size = stream.size();
  std::uint32_t frames = 0;
  while (size > 0) {
    ASSERT_EQ(sac_decoder_send(decoder, &data, &size), SAC_OK);
    while (sac_decoder_receive(decoder, nullptr, nullptr) == SAC_OK) ++frames;
  }
  EXPECT_EQ(sac_decoder_finish(decoder), SAC_OK);
  sac_decoder_close(decoder);
  EXPECT_EQ(frames, kFrames);
  EXPECT_GT(jobs, 4u);
  sac_settings_init(nullptr);  // harmless
}

}  // namespace
}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
// Decodes with the n-th allocation failing, for one n after another: an error that says so, and nothing lost. spec.md
// 11, R60.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "sac/decoder.h"
#include "tests/codec/counted_memory.h"

namespace sac {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes Read(const char* file) {
  std::ifstream in(std::filesystem::path(SAC_CONFORMANCE) / "valid" / file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  const std::vector<char> text{std::istreambuf_iterator<char>(in), {}};
  return {text.begin(), text.end()};
}

// Sends all of `stream` in two chunks, drops the frames.
Status DecodeAll(Decoder& decoder, const Bytes& stream, std::vector<Positions>* frames = nullptr) {
  DecodedFrame frame;
  Status status;
  const std::span<const std::uint8_t> all(stream);
  for (std::span<const std::uint8_t> rest : {all.first(all.size() / 2), all.subspan(all.size() / 2)}) {
    while (!rest.empty()) {
      SAC_RETURN_IF_ERROR(decoder.Send(rest));
      while ((status = decoder.Receive(frame)).ok()) {
        if (frames) frames->push_back(frame.positions);
      }
      if (status.code() != StatusCode::kNeedMoreData) return status;
    }
  }
  return decoder.Finish();
}

struct Trial {
  Status status;
  bool made = false;   // the decoder
  bool threw = false;  // an exception left the library
  long allocations = 0;
  long lost = 0;
};

// `fails`: how many allocations succeed before the one that fails, -1 for none; and all after it if `on`.
Trial Try(const Bytes& stream, long fails, bool on) {
  Trial trial;
  const long living = counted_memory.living, before = counted_memory.allocations;
  counted_memory.until_failure = fails;
  counted_memory.fail_on = on;
  try {
    Decoder decoder;
    trial.made = true;
    trial.status = DecodeAll(decoder, stream);
  } catch (const std::bad_alloc&) {
    trial.threw = true;
  }
  counted_memory.until_failure = -1;
  trial.allocations = counted_memory.allocations - before;
  trial.lost = counted_memory.living - living;
  return trial;
}

void FailEach(const char* file, long most_trials) {
  SCOPED_TRACE(file);
  const Bytes stream = Read(file);
  (void)Try(stream, -1, false);  // what is made once
  const Trial whole = Try(stream, -1, false);
  ASSERT_TRUE(whole.status.ok());
  ASSERT_EQ(whole.lost, 0);
  ASSERT_GT(whole.allocations, 100);
  const long stride = 1 + whole.allocations / most_trials;
  long refused = 0, unharmed = 0;
  for (long n = 0; n < whole.allocations; n += stride) {
    for (const bool on : {false, true}) {
      const Trial trial = Try(stream, n, on);
      EXPECT_EQ(trial.lost, 0) << "allocation " << n;
      EXPECT_EQ(trial.threw, !trial.made) << "allocation " << n;  // a constructor has no other way
      if (!trial.made) continue;
      if (!on && trial.status.ok()) {
        ++unharmed;  // one of those that need not succeed
        continue;
      }
      ++refused;
      EXPECT_EQ(trial.status.code(), StatusCode::kLimit) << "allocation " << n << ": " << trial.status.message();
      EXPECT_EQ(trial.status.message(), "out of memory");
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_LT(unharmed, refused / 4);
}

// With memory again, the clip is played from its begin as if nothing had been.
void GoOnAfterEach(const char* file, unsigned threads) {
  SCOPED_TRACE(file);
  const Bytes stream = Read(file);
  DecoderSettings settings;
  settings.threads = threads;
  std::vector<Positions> whole;
  {
    Decoder decoder(settings);
    ASSERT_TRUE(DecodeAll(decoder, stream, &whole).ok());
  }
  int sought = 0;
  const long allocations = Try(stream, -1, false).allocations;
  for (long n = 0; n < allocations; n += 1 + allocations / 150) {
    Decoder decoder(settings);
    counted_memory.until_failure = n;
    counted_memory.fail_on = true;
    (void)DecodeAll(decoder, stream);
    counted_memory.until_failure = -1;
    std::uint64_t byte = 0;
    if (!decoder.Seek(0, byte).ok()) continue;  // before the mesh was there
    ++sought;
    DecodedFrame between;
    (void)decoder.Interpolate(0.5, between);
    ASSERT_TRUE(decoder.Seek(0, byte).ok());
    std::vector<Positions> again;
    const Status status =
        DecodeAll(decoder, Bytes(stream.begin() + static_cast<std::ptrdiff_t>(byte), stream.end()), &again);
    ASSERT_TRUE(status.ok()) << "allocation " << n << ": " << status.message();
    ASSERT_EQ(again, whole) << "allocation " << n;
  }
  EXPECT_GT(sought, 10);
}

TEST(AllocationFailure, IsOverWhenItIsOver) {
  GoOnAfterEach("small.sac", 1);
  GoOnAfterEach("groups_of_one.sac", 1);
  GoOnAfterEach("previous.sac", 1);
  GoOnAfterEach("pyramids.sac", 1);
}

// Each allocation of streams without and with Draco, whole and open groups, exact and reduced harmonics.
TEST(AllocationFailure, IsALimit) {
  FailEach("small.sac", 2000);
  FailEach("open_groups.sac", 300);
  FailEach("odd.sac", 2000);
  FailEach("previous_everything.sac", 400);
  FailEach("exact.sac", 400);
  FailEach("pyramids.sac", 500);
}

}  // namespace
}  // namespace sac

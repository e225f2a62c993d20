// SPDX-License-Identifier: Apache-2.0
// Decodes the streams of directories after random mutations, half of them with checksums repaired, and their prefixes:
// all of them when there are no more than mutations.
// usage: mutate_vectors MUTATIONS [--seed N] [--seconds MOST] [--megabytes MOST] FILE_OR_DIRECTORY...
//   --seconds    processor time that no case may exceed; without it the slowest is only told
//   --megabytes  memory that the program may have used in the end; likewise
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "sac/decoder.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/stream_mutation.h"

namespace {

using namespace sac;

// Enough for every vector.
Limits VectorLimits() {
  Limits limits;
  limits.vertices = 4000;
  limits.expert.triangles = 8000;
  limits.expert.harmonics = 200;
  limits.expert.frames_per_group = 2000;
  limits.expert.packet_bytes = 1 << 16;
  limits.expert.group_values = 1 << 20;
  limits.expert.basis_values = 1 << 18;
  limits.expert.factor_values = 1 << 18;
  limits.memory = 1 << 26;
  limits.work = limits.expert.free_work = 5e8;
  limits.expert.frame_work = 1e7;
  return limits;
}

struct Counts {
  std::size_t accepted = 0, refused = 0;
  double slowest = 0;
};

double Now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void Try(const Bytes& stream, Counts& counts) {
  alarm(60);  // ends what hangs
  const double start = Now();
  DecoderSettings settings;
  settings.limits = VectorLimits();
  Decoder decoder(settings);
  DecodedFrame frame;
  Status status;
  for (std::span<const std::uint8_t> rest(stream); status.ok() && !rest.empty();) {
    status = decoder.Send(rest);
    if (!status.ok()) break;
    while ((status = decoder.Receive(frame)).ok()) {
    }
    if (status.code() == StatusCode::kNeedMoreData) status = Status::Ok();
  }
  if (status.ok()) status = decoder.Finish();
  FUZZ_REQUIRE(status.ok() || status.code() == StatusCode::kCorrupt || status.code() == StatusCode::kLimit ||
               status.code() == StatusCode::kUnsupported);
  ++(status.ok() ? counts.accepted : counts.refused);
  counts.slowest = std::max(counts.slowest, Now() - start);
}

Counts TryAll(const Bytes& stream, long mutations, std::mt19937& random) {
  Counts counts, prefixes;
  Try(stream, counts);
  const std::size_t most = static_cast<std::size_t>(mutations) + 1, stride = 1 + stream.size() / most;
  for (std::size_t size = 0; size < stream.size(); size += stride) {
    const Bytes prefix(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size));
    Try(prefix, prefixes);
  }
  FUZZ_REQUIRE(counts.accepted == 0 || prefixes.accepted == 0);
  counts.slowest = std::max(counts.slowest, prefixes.slowest);
  for (long i = 0; i < mutations; ++i) {
    Bytes mutated = stream;
    if (i % 2 == 0) {
      mutated = MutateStream(stream, random);
    } else {
      MutateAtRandom(mutated, random);
    }
    Try(mutated, counts);
  }
  return counts;
}

}  // namespace

int main(int argc, char** argv) {
  const long mutations = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 0;
  unsigned long seed = 1;
  double seconds = 0, megabytes = 0;
  std::vector<std::filesystem::path> files;
  for (int i = 2; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind("--", 0) == 0 && i + 1 < argc) {
      const char* value = argv[++i];
      if (argument == "--seed") seed = std::strtoul(value, nullptr, 10);
      if (argument == "--seconds") seconds = std::strtod(value, nullptr);
      if (argument == "--megabytes") megabytes = std::strtod(value, nullptr);
    } else if (std::filesystem::is_directory(argument)) {
      for (const auto& entry : std::filesystem::directory_iterator(argument)) files.push_back(entry.path());
    } else {
      files.emplace_back(argument);
    }
  }
  std::sort(files.begin(), files.end());
  if (files.empty()) {
    std::fprintf(stderr, "usage: mutate_vectors MUTATIONS [--seed N] [--seconds S] [--megabytes M] FILE...\n");
    return 2;
  }
  bool good = true;
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> text{std::istreambuf_iterator<char>(in), {}};
    std::mt19937 random(static_cast<std::uint32_t>(seed));
    const Counts counts = TryAll({text.begin(), text.end()}, mutations, random);
    std::printf("%-32s %zu bytes, %ld mutations: %zu accepted, %zu refused, slowest %.2f s\n", file.filename().c_str(),
                text.size(), mutations, counts.accepted, counts.refused, counts.slowest);
    std::fflush(stdout);
    good = good && (seconds == 0 || counts.slowest <= seconds);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double used = static_cast<double>(usage.ru_maxrss) / 1024;
  std::printf("%zu streams, at most %.0f MB\n", files.size(), used);
  return good && (megabytes == 0 || used <= megabytes) ? 0 : 1;
}

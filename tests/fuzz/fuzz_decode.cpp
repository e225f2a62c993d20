// SPDX-License-Identifier: Apache-2.0
// The whole decoder, in chunks whose sizes are drawn from the input, with small limits.
#include <algorithm>
#include <random>
#include <vector>

#include "format/crc32.h"
#include "sac/decoder.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/stream_mutation.h"

namespace {

using namespace sac;

struct Outcome {
  Status status;
  std::vector<DecodedFrame> frames;
};

// `chunks` draws their sizes, all bytes are one chunk without it.
Outcome Decode(std::span<const std::uint8_t> stream, std::mt19937* chunks) {
  Outcome out;
  DecoderSettings settings;
  settings.limits = FuzzLimits();
  Decoder decoder(settings);
  DecodedFrame frame;
  while (!stream.empty()) {
    const std::size_t size =
        chunks ? std::min<std::size_t>(stream.size(), 1 + ((*chunks)() >> (*chunks)() % 32)) : stream.size();
    const std::vector<std::uint8_t> buffer(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size));
    stream = stream.subspan(size);
    for (std::span<const std::uint8_t> rest(buffer); !rest.empty();) {
      out.status = decoder.Send(rest);
      if (!out.status.ok()) return out;
      while ((out.status = decoder.Receive(frame)).ok()) {
        FUZZ_REQUIRE(decoder.mesh() && frame.positions.size() == decoder.mesh()->positions.size());
        FUZZ_REQUIRE(frame.index == out.frames.size());
        out.frames.push_back(frame);
      }
      if (out.status.code() != StatusCode::kNeedMoreData) return out;
    }
  }
  out.status = decoder.Finish();
  if (!decoder.mesh()) return out;
  const Mesh& mesh = *decoder.mesh();
  const auto below = [](const std::vector<Triangle>& triangles, std::size_t end) {
    return std::all_of(triangles.begin(), triangles.end(),
                       [end](const Triangle& t) { return *std::max_element(t.begin(), t.end()) < end; });
  };
  FUZZ_REQUIRE(mesh.positions.size() == decoder.info()->vertices);
  FUZZ_REQUIRE(mesh.triangles.size() == decoder.info()->triangles);
  FUZZ_REQUIRE(below(mesh.triangles, mesh.positions.size()));
  FUZZ_REQUIRE(below(mesh.uv_triangles, mesh.uvs.size()));
  FUZZ_REQUIRE(below(mesh.normal_triangles, mesh.normals.size()));
  FUZZ_REQUIRE(!mesh.normal_triangles.empty() || mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
  FUZZ_REQUIRE(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size());
  FUZZ_REQUIRE(decoder.order().empty() || decoder.order().size() == mesh.positions.size());
  return out;
}

// Passing over damage.
void DecodeAround(std::span<const std::uint8_t> stream, std::mt19937& chunks) {
  DecoderSettings settings;
  settings.limits = FuzzLimits();
  settings.skip_damage = true;
  Decoder decoder(settings);
  DecodedFrame frame;
  std::uint64_t next = 0;
  const auto drain = [&] {
    while (decoder.Receive(frame).ok()) {
      FUZZ_REQUIRE(frame.index >= next && frame.positions.size() == decoder.mesh()->positions.size());
      next = std::uint64_t{frame.index} + 1;
    }
  };
  while (!stream.empty()) {
    const std::size_t size = std::min<std::size_t>(stream.size(), 1 + (chunks() >> chunks() % 32));
    std::span<const std::uint8_t> part = stream.first(size);
    stream = stream.subspan(size);
    while (!part.empty()) {
      if (!decoder.Send(part).ok()) return;
      drain();
    }
  }
  (void)decoder.Finish();
  drain();
}

void CheckStatus(const Status& status) {
  FUZZ_REQUIRE(status.ok() == status.message().empty());
  FUZZ_REQUIRE(status.message().find('\n') == std::string::npos);
  FUZZ_REQUIRE(status.code() != StatusCode::kNeedMoreData && status.code() != StatusCode::kInvalidArgument &&
               status.code() != StatusCode::kIoError);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> input(data, size);
  const Outcome plain = Decode(input, nullptr);
  CheckStatus(plain.status);
  if (plain.status.ok()) return 0;
  // What a checksum would keep away.
  const Bytes repaired = Repaired(input);
  const std::uint32_t seed = Crc32(input);
  std::mt19937 chunks(seed);
  DecodeAround(input, chunks);
  const Outcome outcome = Decode(repaired, &chunks);
  CheckStatus(outcome.status);
  if (seed % 8 != 0) return 0;
  // Chunks are of no consequence.
  const Outcome whole = Decode(repaired, nullptr);
  FUZZ_REQUIRE(whole.status.code() == outcome.status.code() && whole.status.message() == outcome.status.message());
  FUZZ_REQUIRE(whole.frames.size() == outcome.frames.size());
  for (std::size_t i = 0; i < whole.frames.size(); ++i) {
    FUZZ_REQUIRE(whole.frames[i].positions == outcome.frames[i].positions);
  }
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
// Writes a synthetic clip as a stream to the standard output: for tests and the demonstration of bindings/js, which
// need no other build of the encoder for that. usage: make_clip KIND VERTICES FRAMES QUALITY GROUP [BASE_LEVELS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "sac/clip_encoder.h"
#include "synth/synth.h"

int main(int argc, char** argv) {
  const auto& names = sac::kSynthKindNames;
  const auto kind = argc == 6 || argc == 7 ? std::find_if(names.begin(), names.end(),
                                                          [&](const char* n) { return std::strcmp(n, argv[1]) == 0; })
                                           : names.end();
  if (kind == names.end()) {
    std::fprintf(stderr, "usage: make_clip KIND VERTICES FRAMES QUALITY GROUP [BASE_LEVELS]\n");
    return 2;
  }
  const auto number = [&](int i) { return static_cast<std::uint32_t>(std::strtoul(argv[i], nullptr, 10)); };
  sac::SynthClip clip;
  sac::Status status = sac::SynthClip::Create(
      {.kind = static_cast<sac::SynthKind>(kind - names.begin()), .vertices = number(2), .frames = number(3)}, clip);
  sac::ClipEncoding encoding;
  encoding.measure = false;  // the first frame is the reference: the clip is made in seconds
  encoding.encoder.quality = std::strtod(argv[4], nullptr);
  encoding.encoder.group = number(5);
  if (argc == 7) encoding.encoder.base_levels = number(6);
  sac::EncodedClip result;
  const auto sink = [](std::span<const std::uint8_t> bytes) {
    return std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size()
               ? sac::Status::Ok()
               : sac::Status::InvalidArgument("cannot write");
  };
  if (status.ok()) status = sac::EncodeClip(clip, encoding, sink, result);
  if (!status.ok()) std::fprintf(stderr, "make_clip: %s\n", status.message().c_str());
  return status.ok() ? 0 : 1;
}

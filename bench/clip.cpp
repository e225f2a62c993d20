// SPDX-License-Identifier: Apache-2.0
#include "bench/clip.h"

#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>

#include "sac/encoder.h"
#include "sac/status.h"
#include "synth/synth.h"

namespace sac::bench {
namespace {

void Require(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "speed: %s\n", status.message().c_str());
  std::exit(1);
}

CodedClip MakeClip(std::uint32_t vertices) {
  SynthClip source;
  Require(SynthClip::Create({.kind = SynthKind::kWalker, .vertices = vertices, .frames = kFrames}, source));
  CodedClip coded;
  Clip& clip = coded.clip;
  clip.mesh = source.mesh();
  std::unique_ptr<Encoder> encoder;
  Require(Encoder::Create(clip.mesh, {}, encoder));
  for (std::uint32_t f = 0; f < kFrames; ++f) {
    clip.frames.push_back(source.Frame(f));
    Require(encoder->Send(clip.frames.back()));
  }
  Require(encoder->Finish());
  coded.stream = encoder->TakeBytes();
  return coded;
}

}  // namespace

const CodedClip& WalkerClip(std::uint32_t vertices) {
  static std::map<std::uint32_t, CodedClip> clips;
  const auto found = clips.find(vertices);
  return found != clips.end() ? found->second : clips.emplace(vertices, MakeClip(vertices)).first->second;
}

}  // namespace sac::bench

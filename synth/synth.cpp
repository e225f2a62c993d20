// SPDX-License-Identifier: Apache-2.0
#include "synth/synth.h"

#include <string>
#include <utility>

#include "synth/kinds.h"

namespace sac {
namespace {

synth::Animation Make(const SynthSettings& settings) {
  const synth::Random random(settings.seed);
  switch (settings.kind) {
    case SynthKind::kWalker:
      return synth::MakeWalker(settings.vertices, random);
    case SynthKind::kFlag:
      return synth::MakeFlag(settings.vertices, random);
    case SynthKind::kSphere:
      return synth::MakeSphere(settings.vertices, random);
    case SynthKind::kParts:
      return synth::MakeParts(settings.vertices, random);
    case SynthKind::kVase:
      return synth::MakeVase(settings.vertices, random);
  }
  return {};
}

}  // namespace

std::uint32_t MinSynthVertices(SynthKind kind) {
  switch (kind) {
    case SynthKind::kWalker:
      return 2000;  // on coarser lattices the legs grow together
    case SynthKind::kFlag:
      return 4;
    case SynthKind::kSphere:
      return 12;
    case SynthKind::kParts:
      return 4;
    case SynthKind::kVase:
      return 50;
  }
  return 0;
}

Status SynthClip::Create(const SynthSettings& settings, SynthClip& clip) {
  const auto kind = static_cast<std::size_t>(settings.kind);
  if (kind >= kSynthKindNames.size()) return Status::InvalidArgument("unknown kind of synthetic clip");
  const std::string name = kSynthKindNames[kind];
  if (const std::uint32_t least = MinSynthVertices(settings.kind); settings.vertices < least) {
    return Status::InvalidArgument("a " + name + " needs at least " + std::to_string(least) + " vertices");
  }
  if (settings.vertices > kMaxSynthVertices) {
    return Status::InvalidArgument("a " + name + " has at most " + std::to_string(kMaxSynthVertices) + " vertices");
  }
  if (settings.frames == 0) return Status::InvalidArgument("a clip needs at least one frame");

  synth::Animation animation = Make(settings);
  clip.mesh_ = std::move(animation.mesh);
  clip.motion_ = std::move(animation.motion);
  clip.frames_ = settings.frames;
  clip.mesh_.positions = clip.Frame(0);
  return Status::Ok();
}

}  // namespace sac

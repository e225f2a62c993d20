// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "sac/clip.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Procedural animations of any size, for tests, demonstrations and measurements at scale.
enum class SynthKind {
  kWalker,  // an articulated figure walking along a figure of eight, its arms turning full circles; one closed surface
  kFlag,    // a flag in the wind, pinned at one side, with wrinkles of several scales; has texture coordinates
  kSphere,  // a geodesic sphere, rotating and pulsating in low spherical harmonics; has normals
  kParts,   // many small rigid pieces, each tumbling along its own path; has colours
  kVase,    // a surface of revolution moving rigidly; has texture coordinates with a seam
};

// The names of the kinds, in the order of SynthKind.
inline constexpr std::array<const char*, 5> kSynthKindNames{"walker", "flag", "sphere", "parts", "vase"};

inline constexpr std::uint32_t kMaxSynthVertices = 20'000'000;

// The fewest vertices that a clip of the kind may be asked for.
std::uint32_t MinSynthVertices(SynthKind kind);

struct SynthSettings {
  SynthKind kind = SynthKind::kWalker;
  // The wanted number of vertices. From 500 on the clip's number is within 15 % of it; below, the shapes are too coarse
  // to come that near.
  std::uint32_t vertices = 5000;
  std::uint32_t frames = 100;
  std::uint32_t seed = 1;  // varies proportions, phases, paths; equal settings give equal clips
};

// A clip whose frames are computed one at a time, so that memory does not depend on their number. Random numbers do not
// depend on the standard library, so that the clips of two machines differ only by the rounding of their mathematical
// functions.
//
//   SynthClip clip;
//   SAC_RETURN_IF_ERROR(SynthClip::Create({.kind = SynthKind::kFlag, .vertices = 10000}, clip));
//   for (std::uint32_t f = 0; f < clip.frames(); ++f) Use(clip.Frame(f));
class SynthClip : public ClipReader {
 public:
  // An empty clip.
  SynthClip() = default;

  // Makes a clip. Returns kInvalidArgument for fewer than MinSynthVertices() or more than kMaxSynthVertices vertices,
  // and for no frames; `clip` then stays as it was.
  static Status Create(const SynthSettings& settings, SynthClip& clip);

  // Frame 0 with its attributes.
  const Mesh& mesh() const override { return mesh_; }
  FrameRate rate() const override { return {kFps, 1}; }
  std::optional<std::uint32_t> frame_count() const override { return frames_; }
  Status Next(Positions& frame, bool& end) override {
    end = next_ == frames_;
    if (!end) frame = Frame(next_++);
    return Status::Ok();
  }
  Status Rewind() override {
    next_ = 0;
    return Status::Ok();
  }

  std::uint32_t frames() const { return frames_; }
  double fps() const { return kFps; }

  // The positions of frame `f` < frames(), in metres, with y up. Frames may be asked for in any order and from several
  // threads at once.
  Positions Frame(std::uint32_t f) const { return motion_(f / double{kFps}); }

 private:
  static constexpr std::uint32_t kFps = 30;

  Mesh mesh_;
  std::uint32_t frames_ = 0, next_ = 0;
  std::function<Positions(double seconds)> motion_;
};

}  // namespace sac

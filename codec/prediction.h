#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "format/frame_syntax.h"
#include "format/sequence_header.h"

namespace sac {

// Coefficients of planes are counted in sixteenths of a step, so that levels of a pyramid can have steps of their own.
inline constexpr std::int32_t kCoefficientsPerStep = 16;

// The step of a pyramid's level in those units (spec.md 6.3): 16 at level 0, then each level's the one's before times
// level_growth / 64, rounded, at most 4096.
std::int32_t LevelStep(const SequenceHeader& header, std::uint32_t level);

// A frame's values: what prediction and residuals add up to.
struct FrameCoefficients {
  std::array<std::int32_t, 6> rigid = {};  // in the header's rotation and translation steps
  std::vector<std::int32_t> motion;        // harmonics x kMotionChannels, in sixteenths of a step
  std::vector<std::int32_t> displacement;  // harmonics x kDisplacementChannels, in sixteenths of a step

  explicit FrameCoefficients(std::size_t harmonics = 0)
      : motion(harmonics * kMotionChannels), displacement(harmonics * kDisplacementChannels) {}
};

// Predicts the frames of one group from those coded before (spec.md 6.3). Integers alone: encoder and decoder cannot
// drift apart.
class Predictor {
 public:
  Predictor(const SequenceHeader& header, std::size_t harmonics);

  // From zero, one or the mean of two of the frames added, by their indices in coding order.
  FrameCoefficients Predict(const std::vector<std::uint32_t>& references) const;
  // Appends prediction plus residual, the next frame in coding order. False when a sum leaves the range of spec.md 6.3.
  bool Add(const FrameSyntax& frame);

  const std::vector<FrameCoefficients>& frames() const { return frames_; }

 private:
  SequenceHeader header_;
  std::size_t harmonics_;
  std::vector<FrameCoefficients> frames_;
};

}  // namespace sac

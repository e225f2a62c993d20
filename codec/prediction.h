#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "format/frame_syntax.h"
#include "format/sequence_header.h"

namespace sac {

// A frame's values in units of the header's steps: what prediction and residuals add up to.
struct FrameCoefficients {
  std::array<std::int32_t, 6> rigid = {};
  std::vector<std::int32_t> motion;        // harmonics x kMotionChannels
  std::vector<std::int32_t> displacement;  // harmonics x kDisplacementChannels

  explicit FrameCoefficients(std::size_t harmonics = 0)
      : motion(harmonics * kMotionChannels), displacement(harmonics * kDisplacementChannels) {}
};

// Predicts a group's frames from those before (spec.md 6.3). Integers alone: encoder and decoder cannot drift apart.
class Predictor {
 public:
  Predictor(ReferenceShape reference_shape, std::size_t harmonics);

  // The prediction of the next frame.
  FrameCoefficients Predict(bool intra) const;
  // Prediction plus residual, which becomes the newest frame. False when a sum leaves the range of spec.md 6.3.
  bool Add(const FrameSyntax& frame, FrameCoefficients& out);
  void StartGroup();

 private:
  ReferenceShape reference_shape_;
  std::size_t harmonics_;
  FrameCoefficients last_;
  std::array<std::int32_t, 6> rigid_velocity_ = {};
};

}  // namespace sac

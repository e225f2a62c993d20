// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "format/frame_syntax.h"
#include "format/plane_layout.h"
#include "format/rigid_motion.h"
#include "format/sequence_header.h"

namespace sac {

// Coefficients of planes are counted in sixteenths of a step, so that levels of a pyramid can have steps of their own.
inline constexpr std::int32_t kCoefficientsPerStep = 16;

// The step of a plane at a pyramid's level in those units (spec.md 6.3): 16 at level 0, then each level's the one's
// before times level_growth / 64, rounded, at most 4096; always 16 for the correction plane.
std::int32_t LevelStep(const SequenceHeader& header, std::size_t plane, std::uint32_t level);

// A frame's values: what prediction and residuals add up to.
struct FrameCoefficients {
  RigidMotion rigid;   // in the header's rotation and translation steps
  FramePlanes planes;  // in sixteenths of a step
};

// The frames that one is predicted from, none, one twice or two, and those as far beyond them in time, if they are
// coded (spec.md 6.3).
struct ReferenceFrames {
  const FrameCoefficients* first = nullptr;
  const FrameCoefficients* second = nullptr;
  const FrameCoefficients* before = nullptr;  // as far from `first` as the other end, on the other side
  const FrameCoefficients* after = nullptr;   // likewise from `second`
  bool one = false;                           // and `before` is as far from the one as the frame itself

  // Where the course of a plane's coefficient i bends to between two references, in sixteenths of the coefficient;
  // each frame beyond adds half of a parabola's. From one reference, half of how far it came.
  std::int64_t Bend(std::size_t plane, std::size_t i) const {
    if (one) return before ? 8 * (std::int64_t{first->planes[plane][i]} - before->planes[plane][i]) : 0;
    const std::int64_t a = first->planes[plane][i], b = second->planes[plane][i];
    return (before ? 2 * a - b - before->planes[plane][i] : 0) + (after ? 2 * b - a - after->planes[plane][i] : 0);
  }
};

// Predicts the frames of one group from those coded before (spec.md 6.3). Integers alone: encoder and decoder cannot
// drift apart.
class Predictor {
 public:
  Predictor(const SequenceHeader& header, const PlaneLayouts& layouts);

  // From zero, one or two of the frames added, whose indices in coding order the slot has.
  FrameCoefficients Predict(const FrameSlot& slot) const;
  // The references of a frame at `slot`, of which `index` frames come before it in coding order.
  ReferenceFrames FindReferences(const FrameSlot& slot, std::size_t index) const;
  // Appends prediction plus residual, the next frame in coding order. False when a sum leaves the range of spec.md 6.3.
  bool Add(const FrameSyntax& frame);
  // Does the same with one plane of frame number `index` in coding order, which has been added with zeros there.
  bool AddPlane(std::size_t index, const FrameSyntax& frame, std::size_t plane);

  const std::vector<FrameCoefficients>& frames() const { return frames_; }
  std::vector<FrameCoefficients> TakeFrames() { return std::move(frames_); }

 private:
  // Whether a plane is predicted at all.
  bool Predicts(std::size_t plane) const;
  // The frame shown at a time within the group, if it is one of the first `count` in coding order.
  const FrameCoefficients* FrameAt(std::int64_t display, std::size_t count) const;
  // Adds the prediction of a plane to zeros.
  void PredictPlane(const FrameSlot& slot, const ReferenceFrames& frames, std::size_t plane, PlaneValues& values) const;

  SequenceHeader header_;
  FramePlanes zeros_;
  std::vector<FrameCoefficients> frames_;
  std::vector<std::uint32_t> displays_;  // of frames_
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "format/plane_layout.h"
#include "format/prediction.h"

namespace sac {

// The inputs from which the bins of one residual are predicted (spec.md 7.4).
struct ResidualContext {
  static constexpr std::size_t kStates = 6, kFeatures = 6;

  std::array<std::size_t, kStates> states;       // the context of each kind
  std::array<std::int32_t, kFeatures> features;  // on the scale of logits
  std::size_t level;                             // at most 4
  std::size_t activity;                          // 0..23
  std::array<std::size_t, 2> sign_states;        // the contexts of the sign
};

// Derives the context of each residual of a plane from what is known before it is coded, over the frames of a group.
class ResidualContexts {
 public:
  static constexpr std::size_t kActivities = 24;
  static constexpr std::size_t kLevels = 5;
  static constexpr std::array<std::size_t, 2> kSignContexts = {17 * kLevels, 9 * kLevels};

  explicit ResidualContexts(const PlaneLayout& layout);

  // The number of contexts of each kind.
  const std::array<std::size_t, ResidualContext::kStates>& sizes() const { return sizes_; }

  // Begins a frame of pyramid level `level`, whose step is `step`. `references` holds the coefficients of `plane`;
  // `first` and `second` are the residuals of the frame's references, or zeros.
  void Start(std::uint32_t level, std::int32_t step, std::size_t plane, const ReferenceFrames& references,
             std::span<const std::int32_t> first, std::span<const std::int32_t> second);
  // Returns the context of the next residual, in the order of the plane.
  ResidualContext Next();
  // Records the value of the residual whose context Next() returned last.
  void Put(std::int32_t residual);
  // Ends the frame. `values` holds all of its residuals.
  void Finish(std::span<const std::int32_t> values);

 private:
  // The part of the context of one coefficient that is known before the frame's residuals are.
  struct Place {
    std::uint32_t around = 0;         // the references' magnitudes here and in the rows beside
    std::uint8_t recent = 0;          // classes of magnitudes of frames before: here,
    std::uint8_t recent_around = 0;   // and with the rows beside
    std::uint8_t spread = 0;          // class of the difference of the references' coefficients
    std::uint8_t bend = 0;            // class of the bend
    std::uint8_t bend_sign = 0;       // context of the sign
    std::uint8_t reference_sign = 0;  // 0..2
    bool touched = false;             // whether a reference has a residual here
  };

  PlaneLayout layout_;
  std::size_t channels_;
  std::array<std::size_t, ResidualContext::kStates> sizes_;
  std::size_t level_ = 0;
  std::int32_t step_ = 1;
  std::vector<Place> places_;
  std::vector<std::int32_t> recent_;       // mean magnitude of frames before, in 1/64 of a step of level 0
  std::vector<std::uint32_t> magnitudes_;  // of this frame, after four rows of zeros
  std::vector<std::int8_t> signs_;         // of this frame, after a row of zeros
  std::size_t next_ = 0;
  std::uint32_t before_ = 0;  // sum of magnitudes over the channels before in the row
};

}  // namespace sac

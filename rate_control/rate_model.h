// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "rate_control/trial.h"

namespace sac {

// What a trial comes to, or is predicted to come to.
struct RateFigures {
  double bytes = 0;
  double kg = 0;  // percent
  double sted = 0;
};

// What steps, bits and harmonics come to, predicted from trials of the same clip with or without detail.
//
// KG and STED are root sums of squares of parts (quantization, what the harmonics leave out, noise of the I-frame), the
// bytes a sum over the planes; each part goes with a power of what it depends on, measured on several clips
// (docs/rate-control.md). How large the parts are is fitted to the trials, near ones first; what they still miss is
// corrected in the neighbourhood of each trial.
class RateModel {
 public:
  // At least one; all with detail or all without. Predictions are wanted around `centre`.
  RateModel(const std::vector<const Trial*>& trials, const Trial& centre);

  RateFigures Predict(const OperatingPoint& point) const;

 private:
  using Parts = Eigen::Array3d;
  // The logarithm of a figure is scale + log(sum of parts exp(logs)) / 2.
  struct Sum {
    Parts logs;  // by which parts differ from those of a typical clip
    double scale;
  };
  // The logarithms by which a trial's bytes, KG and STED are beyond what the formulas say.
  struct Miss {
    OperatingPoint point;
    Eigen::Array3d logs;
  };

  static Parts KgParts(const OperatingPoint& point);    // of KG squared, about
  static Parts StedParts(const OperatingPoint& point);  // of STED squared
  Sum Fit(const std::vector<const Trial*>& trials, Parts (*parts)(const OperatingPoint&), double Trial::*figure) const;
  RateFigures Formulas(const OperatingPoint& point) const;

  Trial centre_;
  Sum kg_, sted_;
  double bytes_per_bit_;  // of positions
  std::vector<Miss> misses_;
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "rate_control/trial.h"

namespace sac {

// The measured or predicted size and errors of a trial.
struct RateFigures {
  double bytes = 0;  // of the whole stream
  double kg = 0;     // percent
  double sted = 0;
};

// Predicts the size and errors that given steps, bits and harmonics lead to, from trials of the same clip.
//
// KG and STED are modelled as square roots of a sum of parts: quantization, truncation of the harmonics, and noise of
// the I-frame. The bytes are a sum over the planes. Each part is a power of the setting that it depends on, with
// exponents measured on several clips (docs/rate-control.md). The sizes of the parts are fitted to the trials, where
// trials near the centre count more. The remaining errors of the model are interpolated between the trials and
// corrected.
class RateModel {
 public:
  // `trials` must not be empty; all of them have a detail plane, or none has. The model is fitted for predictions near
  // `centre`, which is one of them.
  RateModel(const std::vector<const Trial*>& trials, const Trial& centre);

  RateFigures Predict(const OperatingPoint& point) const;

 private:
  using Parts = Eigen::Array3d;
  // A fitted figure: its logarithm is scale + log(sum of parts * exp(logs)) / 2.
  struct Sum {
    Parts logs;  // logarithms of the ratios of the parts to those of a typical clip
    double scale;
  };
  // The logarithms of the ratios of a trial's bytes, KG and STED to the values of the formulas.
  struct Miss {
    OperatingPoint point;
    Eigen::Array3d logs;
  };

  static Parts KgParts(const OperatingPoint& point);    // parts of the square of KG on a typical clip
  static Parts StedParts(const OperatingPoint& point);  // parts of the square of STED on a typical clip
  Sum Fit(const std::vector<const Trial*>& trials, Parts (*parts)(const OperatingPoint&), double Trial::*figure) const;
  RateFigures Formulas(const OperatingPoint& point) const;

  Trial centre_;
  Sum kg_, sted_;
  double bytes_per_bit_;  // bytes of the I-frame for one more position bit
  std::vector<Miss> misses_;
};

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "sac/status.h"

namespace sac {

// Between which two samples a time lies: at `weight`, in 0..1, from sample `low` to sample `high`.
struct AlembicMoment {
  std::uint32_t low = 0, high = 0;
  double weight = 0;
};

// When the samples of a property are taken. Times repeat every `period` seconds, one time (uniform) or several (as for
// motion blur); or each sample has its own.
struct AlembicTimeSampling {
  double period = 1;          // seconds; meaningless where each sample has its own time
  std::vector<double> times;  // seconds: of a period's samples in the first period, or of all samples
  bool acyclic = false;

  // The time of a sample in seconds.
  double Time(std::uint32_t sample) const;

  // Where `time` lies among `samples` samples, at least 1; before the first and after the last it is at that one. A
  // time within 1e-4 of the way to a sample is at that sample, because programs round.
  AlembicMoment At(double time, std::uint32_t samples) const;

  // Periods a second, or the mean number of `samples` samples a second where each has its own time; 0 where that is not
  // defined.
  double Rate(std::uint32_t samples) const;
};

// Reads the list of an archive: for each u32 of the largest number of samples that any property has, f64 period, u32
// count, f64 times. kCorrupt: cut short, without times, or with times that are not finite, do not ascend, or do not fit
// into a period.
Status ParseAlembicTimes(std::string_view bytes, std::vector<AlembicTimeSampling>& samplings);

}  // namespace sac

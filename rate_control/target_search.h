#pragma once

#include <functional>
#include <optional>

#include "rate_control/trial.h"
#include "sac/encoder.h"
#include "sac/status.h"

namespace sac {

// What an encoding is to come to: bounds that are not passed, and met within 3 % where the clip lets them.
struct RateTargets {
  std::optional<double> kg;  // percent
  std::optional<double> sted;
  std::optional<double> bpvf;  // bits a vertex and frame, all bytes counted

  bool any() const { return kg || sted || bpvf; }
};

// Searches the settings that reach `targets`; `base` has the rest (steps, position bits and quality are
// chosen here, harmonics too unless `base` has them).
//
// KG, STED or both: the smallest stream found that keeps them. bpvf: the best quality within the size. bpvf with KG or
// STED: the smallest stream that keeps those, if it is within the size.
//
// `run` encodes and measures with the settings of a trial: 3 to 12 times, up to 24 times where detail and more
// harmonics are about equal. `vertices` of the clip say how many harmonics are worth trying. kInvalidArgument, saying
// what was reached, when the targets cannot be.
Status SearchTargets(const RateTargets& targets, const EncoderSettings& base, std::uint32_t vertices,
                     const std::function<Status(Trial&)>& run, Trial& best);

}  // namespace sac

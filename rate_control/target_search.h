// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "rate_control/trial.h"
#include "sac/clip_encoder.h"
#include "sac/encoder.h"
#include "sac/status.h"

namespace sac {

// Searches the settings that reach `targets`. Steps, position bits and quality are chosen here, and the number of
// harmonics unless `base` has it; everything else comes from `base`.
//
// `run` encodes and measures with the settings of a trial. It is called 3 to 12 times, and up to 24 times where detail
// and more harmonics are about equal. `vertices` of the clip bound the number of harmonics that are worth trying.
// Returns kInvalidArgument with a message that says what was reached when the targets cannot be met.
Status SearchTargets(const RateTargets& targets, const EncoderSettings& base, std::uint32_t vertices,
                     const std::function<Status(Trial&)>& run, Trial& best);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "rate_control/trial.h"
#include "sac/clip_encoder.h"
#include "sac/encoder.h"
#include "sac/mesh.h"
#include "sac/status.h"

namespace sac {

// Searches the settings that reach `targets`. The search chooses the steps, the position bits, the quality and, unless
// `base` sets it, the number of harmonics. All other settings come from `base`.
//
// `run` encodes and measures with the settings of a trial. It is called 3 to 12 times, and up to 24 times where coding
// with and without a detail plane costs about the same. `mesh`, the clip's first frame, bounds the number of
// harmonics that are tried, and its density moves the position bits, as with a quality. Returns kInvalidArgument for
// targets that are not positive, and when the targets cannot be met, with a message that says what was reached;
// otherwise the errors of `run`.
Status SearchTargets(const RateTargets& targets, const EncoderSettings& base, const Mesh& mesh,
                     const std::function<Status(Trial&)>& run, Trial& best);

}  // namespace sac

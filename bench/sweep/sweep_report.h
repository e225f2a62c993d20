// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/sweep/sweep_clip.h"
#include "bench/sweep/sweep_codec.h"
#include "bench/sweep/sweep_run.h"
#include "sac/status.h"

namespace sac {

struct Sweep {
  std::vector<SweepClip> clips;
  std::vector<SweepCodec> codecs;  // the first is sac; the others are compared with it
  std::vector<SweepResult> results;
  unsigned jobs = 1;  // results that were measured at the same time
};

// Writes sweep.csv (one line per result), sweep.json (clips, codecs, results, Bjontegaard rates) and sweep.html, a page
// with plots and decoded shapes that needs no other file and no network.
Status WriteReport(const Sweep& sweep, const std::string& directory);

}  // namespace sac

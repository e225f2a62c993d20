// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/sweep/child_process.h"
#include "bench/sweep/sweep_clip.h"
#include "bench/sweep/sweep_codec.h"
#include "metrics/error_meter.h"
#include "sac/status.h"

namespace sac {

// One clip coded by one codec at one setting. Each was a program of its own that got no more than its files.
struct SweepResult {
  std::size_t clip = 0, codec = 0, setting = 0;
  std::string key;    // of content, program and options; names its files
  std::string error;  // why there is no result; empty when there is one
  std::uint64_t bytes = 0;
  double bpvf = 0;
  DistortionMetrics distortion;
  ProcessUsage encode, decode;
  std::string samples_path;  // of the decoded frames shown: shapes, then errors (display_mesh.h)
};

// All clips by all codecs at all settings, `jobs` at a time. What an earlier run into the same directory has done, with
// the same content, settings and programs, is taken from there. Prints a line for each new result. A codec that fails
// is a result with an error, and is tried again by the next run. With `keep` streams and decoded clips stay beside the
// results.
struct SweepPlaces {
  std::string results, work;  // directories
  bool keep = false;
};
Status RunSweep(const std::vector<SweepClip>& clips, const std::vector<SweepCodec>& codecs, const SweepPlaces& places,
                unsigned jobs, std::vector<SweepResult>& results);

}  // namespace sac

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

// The result of one clip, one codec and one setting. Encoder, decoder and measurement ran as programs of their own,
// each with no more than its files.
struct SweepResult {
  std::size_t clip = 0, codec = 0, setting = 0;
  std::string key;    // key of content, program and options; the names of the result's files
  std::string error;  // why there is no result; empty when there is one
  std::uint64_t bytes = 0;
  double bpvf = 0;
  DistortionMetrics distortion;
  ProcessUsage encode, decode;
  std::string samples_path;  // file of the decoded frames shown: shapes, then errors (display_mesh.h)
};

// The directories of a sweep.
struct SweepPlaces {
  std::string results, work;
  bool keep = false;  // streams and decoded clips stay beside the results
};
// Runs all codecs on all clips at all settings, `jobs` at a time, and prints a line for each new result. A result that
// an earlier run into the same directory measured with the same content, settings and programs is taken from there.
// When a codec fails, the result has an error and is tried again by the next run.
Status RunSweep(const std::vector<SweepClip>& clips, const std::vector<SweepCodec>& codecs, const SweepPlaces& places,
                unsigned jobs, std::vector<SweepResult>& results);

}  // namespace sac

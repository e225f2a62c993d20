// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bench/sweep/sweep_run.h"
#include "cli/distortion_report.h"
#include "sac/status.h"

namespace sac {

// A result as one JSON object, as it is in a sweep's report and in the file that keeps it for the next run.
Json ToJson(const SweepClip& clip, const SweepCodec& codec, const SweepResult& result);

Status WriteResult(const std::string& path, const SweepClip& clip, const SweepCodec& codec, const SweepResult& result);

// False when there is no such file, it is not whole, or the samples it goes with are gone: there is no result then.
bool ReadResult(const std::string& path, SweepResult& result);

// What `sac compare --json` prints. A KG of null is infinite.
bool ReadDistortion(const std::string& text, DistortionMetrics& metrics);

}  // namespace sac

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

// Reads a result. Returns false when the file does not exist or is incomplete, or when its samples are missing.
bool ReadResult(const std::string& path, SweepResult& result);

// Parses the output of `sac compare --json`. A KG of null means infinity.
bool ReadDistortion(const std::string& text, DistortionMetrics& metrics);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>

#include "cli/distortion_report.h"
#include "sac/clip_encoder.h"

namespace sac {

// Sizes in bytes, distortion and settings of an encoding that took `seconds`.
Json EncodingJson(const ClipEncoding& encoding, const EncodedClip& encoded, double seconds);
void PrintEncoding(const ClipEncoding& encoding, const EncodedClip& encoded, double seconds, std::FILE* file);

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>

#include "cli/distortion_report.h"
#include "files/warnings.h"
#include "sac/clip_encoder.h"

namespace sac {

// Sizes in bytes, distortion, settings and warnings of an encoding that took `seconds`.
Json EncodingJson(const ClipEncoding& encoding, const EncodedClip& encoded, const Warnings& warnings, double seconds);
void PrintEncoding(const ClipEncoding& encoding, const EncodedClip& encoded, double seconds, std::FILE* file);

}  // namespace sac

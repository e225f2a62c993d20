// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "files/warnings.h"
#include "sac/clip_encoder.h"

namespace sac {

// What a user may not expect of an encoding. Each line begins with `name`, the clip's. `diagonal` is the one of the
// first frame's bounding box, model units.
Warnings EncodingWarnings(const std::string& name, const ClipEncoding& encoding, const EncodedClip& encoded,
                          double diagonal);

}  // namespace sac

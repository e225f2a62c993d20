// SPDX-License-Identifier: Apache-2.0
#include "rate_control/trial.h"

#include "rate_control/measured_encoding.h"

namespace sac {

void Trial::Take(const EncodedClip& encoded) {
  bytes = encoded.bytes;
  parts = encoded.parts;
  vertices = static_cast<double>(encoded.info.vertices);
  bpvf = encoded.bpvf();
  kg = encoded.distortion.kg;
  sted = encoded.distortion.sted;
}

Status RunTrial(ClipReader& clip, Trial& trial) {
  EncodedClip encoded;
  SAC_RETURN_IF_ERROR(EncodeAndMeasure(clip, trial.settings, {}, encoded));
  trial.Take(encoded);
  return Status::Ok();
}

}  // namespace sac

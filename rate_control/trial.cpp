// SPDX-License-Identifier: Apache-2.0
#include "rate_control/trial.h"

#include "rate_control/measured_encoding.h"

namespace sac {

Status RunTrial(ClipReader& clip, Trial& trial) {
  EncodedClip encoded;
  SAC_RETURN_IF_ERROR(EncodeAndMeasure(clip, trial.settings, true, {}, encoded));
  trial.bytes = encoded.bytes;
  trial.parts = encoded.parts;
  trial.vertices = static_cast<double>(encoded.info.vertices);
  trial.bpvf = encoded.bpvf();
  trial.kg = encoded.distortion.kg;
  trial.sted = encoded.distortion.sted;
  return Status::Ok();
}

}  // namespace sac

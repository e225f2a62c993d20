// SPDX-License-Identifier: Apache-2.0
#include "sac/clip_encoder.h"

#include "codec/encode/contain.h"
#include "rate_control/measured_encoding.h"
#include "rate_control/target_search.h"
#include "rate_control/trial.h"

namespace sac {
namespace {

// The progress callback of an encoder that calls that of the encoding with the number of the trial.
std::function<bool(std::uint32_t)> ProgressOf(const ClipEncoding& encoding, std::uint32_t trial) {
  if (!encoding.progress) return encoding.encoder.progress;
  return [&encoding, trial](std::uint32_t frames) { return encoding.progress({trial, frames}); };
}

Status Search(ClipReader& clip, const ClipEncoding& encoding, EncoderSettings& settings, std::uint32_t& trials) {
  Status of_trial;  // its message already begins with the clip's name
  const auto run = [&](Trial& trial) {
    trial.settings.progress = ProgressOf(encoding, ++trials);
    return of_trial = RunTrial(clip, trial);
  };
  Trial best;
  const auto vertices = static_cast<std::uint32_t>(clip.mesh().positions.size());
  if (const Status found = SearchTargets(encoding.targets, settings, vertices, run, best); !found.ok()) {
    return of_trial.ok() ? Named(clip.name(), found) : found;
  }
  settings = best.settings;
  return Status::Ok();
}

Status Encode(ClipReader& clip, const ClipEncoding& encoding, const ByteSink& sink, EncodedClip& result) {
  EncoderSettings settings = encoding.encoder;
  if (settings.frame_rate_numerator == 0 && clip.rate().numerator != 0) {
    settings.frame_rate_numerator = clip.rate().numerator;
    settings.frame_rate_denominator = clip.rate().denominator;
  }
  std::uint32_t trials = 0;
  if (encoding.targets.any()) SAC_RETURN_IF_ERROR(Search(clip, encoding, settings, trials));
  settings.progress = ProgressOf(encoding, 0);
  SAC_RETURN_IF_ERROR(EncodeAndMeasure(clip, settings, encoding.measure || trials > 0, sink, result));
  result.trials = trials;
  result.settings.progress = encoding.encoder.progress;
  return Status::Ok();
}

}  // namespace

Status EncodeClip(ClipReader& clip, const ClipEncoding& encoding,
                  const std::function<Status(std::span<const std::uint8_t> bytes)>& sink, EncodedClip& result) {
  return Contain([&] { return Encode(clip, encoding, sink, result); });
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "cli/encoding_report.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "rate_control/reference_shape.h"

namespace sac {
namespace {

std::string RateText(const StreamInfo& info) {
  const std::string numerator = std::to_string(info.frame_rate_numerator);
  return info.frame_rate_denominator == 1 ? numerator : numerator + "/" + std::to_string(info.frame_rate_denominator);
}

// They add up to the stream. The encoder counts in whole bytes.
std::vector<std::pair<const char*, long long>> Parts(const StreamBytes& parts) {
  return {{"header", std::llround(parts.header)}, {"i_frame", std::llround(parts.i_frame)},
          {"motion", std::llround(parts.motion)}, {"displacement", std::llround(parts.displacement)},
          {"detail", std::llround(parts.detail)}, {"correction", std::llround(parts.correction)},
          {"side", std::llround(parts.side)}};
}

}  // namespace

Json EncodingJson(const ClipEncoding& encoding, const EncodedClip& encoded, const Warnings& warnings, double seconds) {
  const auto or_null = [](const auto& value) { return value ? Json(*value) : Json(); };
  const StreamInfo& info = encoded.info;
  Json json;
  for (const auto& [part, bytes] : Parts(encoded.parts)) json[part] = bytes;
  json["bytes"] = encoded.bytes;
  json["bpvf"] = encoded.bpvf();
  if (encoding.measure) AddDistortion(encoded.distortion, json);
  json["frames"] = encoded.frames;
  json["segments"] = encoded.segments;
  json["vertices"] = info.vertices;
  json["triangles"] = info.triangles;
  json["harmonics"] = info.harmonics;
  json["fitted_reference"] = encoded.fitted_reference;
  json["seconds"] = seconds;
  if (encoding.targets.any()) json["trials"] = encoded.trials;
  json["warnings"] = warnings;
  const EncoderSettings& encoder = encoded.settings;
  Json& settings = json["settings"];
  settings["target_kg"] = or_null(encoding.targets.kg);
  settings["target_sted"] = or_null(encoding.targets.sted);
  settings["target_bpvf"] = or_null(encoding.targets.bpvf);
  settings["quality"] = encoder.quality;
  settings["fps"] = info.frame_rate_numerator == 0 ? Json() : Json(RateText(info));
  settings["harmonics"] = or_null(encoder.harmonics);  // null: from the quality
  settings["handles_per_harmonic"] = encoder.handles_per_harmonic;
  settings["group"] = encoder.group;
  settings["pyramid"] = encoder.low_delay ? 1 : encoder.pyramid;
  settings["low_delay"] = encoder.low_delay;
  settings["reference"] = encoder.reference_shape == ReferenceShape::kPrevious ? "previous" : "key";
  settings["reference_rounds"] = RoundsOf(encoding);
  settings["motion_step"] = or_null(encoder.motion_step);
  settings["displacement_step"] = or_null(encoder.displacement_step);
  settings["detail_step"] = or_null(encoder.detail_step);
  settings["max_error"] = or_null(encoder.max_error);
  settings["position_bits"] = or_null(encoder.position_bits);
  settings["keep_order"] = encoder.keep_order;
  return json;
}

void PrintEncoding(const ClipEncoding& encoding, const EncodedClip& encoded, double seconds, std::FILE* file) {
  const StreamInfo& info = encoded.info;
  const auto bytes = static_cast<double>(encoded.bytes);
  const double raw = 12 * static_cast<double>(encoded.positions);
  if (encoded.segments > 1) {
    std::fprintf(file, "%u frames of %u meshes, %.0f vertices in the mean\n", encoded.frames, encoded.segments,
                 static_cast<double>(encoded.positions) / encoded.frames);
  } else {
    std::fprintf(file, "%u frames, %u vertices, %u triangles\n", encoded.frames, info.vertices, info.triangles);
  }
  std::fprintf(file, "%.0f bytes, 1 : %.1f of raw float32, %.4g bits a vertex and frame\n", bytes, raw / bytes,
               encoded.bpvf());
  for (const auto& [part, size] : Parts(encoded.parts)) {
    std::fprintf(file, "  %-12s %10lld bytes %5.1f %%\n", part, size, 100 * static_cast<double>(size) / bytes);
  }
  if (encoding.measure) PrintDistortion(encoded.distortion, file);
  if (encoding.targets.any()) {
    const EncoderSettings& s = encoded.settings;
    std::fprintf(
        file,
        "found in %u trials: --motion-step %.4g --displacement-step %.4g --detail-step %.4g --position-bits %.5g "
        "--harmonics %u\n",
        encoded.trials, *s.motion_step, *s.displacement_step, *s.detail_step, *s.position_bits, *s.harmonics);
  }
  std::fprintf(file, "%.2f seconds\n", seconds);
}

}  // namespace sac

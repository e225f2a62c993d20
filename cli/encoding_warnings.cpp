// SPDX-License-Identifier: Apache-2.0
#include "cli/encoding_warnings.h"

#include <cstdio>

#include "rate_control/search_point.h"

namespace sac {
namespace {

// A gap that shows: a pixel where the diagonal fills a thousand.
constexpr double kVisibleGap = 1e-3;
// A part is told of when its error is so many percent of its size, and so many times the error of the whole.
constexpr double kPartKg = 10, kPartOverWhole = 4;
// A quality is told of when an error is so many times the one that it usually gives.
constexpr double kOverTypical = 2;

std::string Number(double value, int digits = 3) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

// A percentage as the beginning of "... its own size".
std::string Share(double percent) {
  return percent < 100 ? Number(percent) + " % of" : Number(percent / 100) + " times";
}

void TellSeams(const EncodedClip& encoded, double diagonal, const std::string& name, Warnings& warnings) {
  const double gap = encoded.distortion.seam_gap;
  if (gap <= kVisibleGap * diagonal) return;
  warnings.push_back(
      name + ": vertices that coincide in every frame decode up to " + Number(gap) + " model units apart, " +
      Number(100 * gap / diagonal) +
      " % of the diagonal; holes may show along seams. A higher --quality, or --max-error, narrows them");
}

void TellParts(const EncodedClip& encoded, const std::string& name, Warnings& warnings) {
  const PartDistortion& part = encoded.distortion.worst_part;
  if (part.kg < kPartKg || part.kg < kPartOverWhole * encoded.distortion.kg) return;
  warnings.push_back(name + ": the part of " + std::to_string(part.vertices) + " vertices that has vertex " +
                     std::to_string(part.first_vertex) + " decodes up to " + Number(part.max_error) +
                     " model units off, " + Share(part.kg) + " its own size (KG " + Number(encoded.distortion.kg) +
                     " % of the whole). --max-error bounds it in model units");
}

// Whether the steps come from the quality alone.
bool HasStepsOfQuality(const ClipEncoding& encoding) {
  const EncoderSettings& s = encoding.encoder;
  return !encoding.targets.any() && !s.motion_step && !s.displacement_step && !s.detail_step && !s.position_bits &&
         !s.harmonics && !s.max_error;
}

void TellQuality(const EncodedClip& encoded, const std::string& name, Warnings& warnings) {
  const double quality = encoded.settings.quality;
  const TypicalFigures typical = TypicalOf(quality);
  const auto tell = [&](const char* figure, const char* unit, const char* option, double value, double usual) {
    if (value <= kOverTypical * usual) return;
    warnings.push_back(name + ": " + figure + " is " + Number(value) + unit + ", where quality " + Number(quality) +
                       " usually gives " + Number(usual, 2) + unit + ". " + option + " " + Number(usual, 2) +
                       " would hold it");
  };
  tell("KG", " %", "--target-kg", encoded.distortion.kg, typical.kg);
  tell("STED", "", "--target-sted", encoded.distortion.sted, typical.sted);
}

}  // namespace

Warnings EncodingWarnings(const std::string& name, const ClipEncoding& encoding, const EncodedClip& encoded,
                          double diagonal) {
  Warnings warnings;
  if (encoded.lost_texture_coordinates) {
    warnings.push_back(name + ": its texture coordinates cannot be coded, the stream has none");
  }
  if (encoded.lost_normals) {
    warnings.push_back(name + ": its hard edges cannot be coded, the stream has no normals");
  }
  if (!encoding.measure && !encoding.targets.any()) return warnings;
  TellSeams(encoded, diagonal, name, warnings);
  TellParts(encoded, name, warnings);
  if (HasStepsOfQuality(encoding)) TellQuality(encoded, name, warnings);
  return warnings;
}

}  // namespace sac

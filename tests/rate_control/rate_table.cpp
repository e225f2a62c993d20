// SPDX-License-Identifier: Apache-2.0
#include "tests/rate_control/rate_table.h"

#include <algorithm>
#include <cstddef>
#include <iomanip>
#include <optional>
#include <sstream>

#include "geometry/bounding_box.h"
#include "rate_control/trial.h"
#include "synth/synth.h"

namespace sac {
namespace {

constexpr char kHeader[] = "clip,vertices,frames,settings,bytes,kg,sted";
constexpr std::size_t kFigures = 3;
constexpr std::ptrdiff_t kNameCommas = 3;

struct Wanted {
  SynthKind kind;
  std::uint32_t vertices, frames;
  std::vector<double> qualities, bounds;  // bounds in diagonals of the first frame's bounding box
};

// Every plane, one component and many, the size at which qualities get more harmonics; few enough to take seconds.
std::vector<Wanted> Table() {
  return {{SynthKind::kWalker, 3600, 24, {0, 50, 65}, {}},
          {SynthKind::kFlag, 600, 24, {25, 50, 70, 80, 100}, {1e-3, 1e-4}},
          {SynthKind::kSphere, 642, 24, {50, 80}, {1e-3}},
          {SynthKind::kParts, 800, 24, {10, 50, 75, 90}, {1e-3}},
          {SynthKind::kVase, 500, 24, {50}, {}}};
}

Status Measure(SynthClip& clip, const std::string& clip_name, const std::string& settings_name,
               const EncoderSettings& settings, std::vector<RateRow>& rows) {
  Trial trial;
  trial.settings = settings;
  SAC_RETURN_IF_ERROR(RunTrial(clip, trial));
  rows.push_back({clip_name + "," + settings_name, trial.bytes, trial.kg, trial.sted});
  return Status::Ok();
}

}  // namespace

Status MeasureRates(std::vector<RateRow>& rows) {
  for (const Wanted& wanted : Table()) {
    SynthClip clip;
    SAC_RETURN_IF_ERROR(SynthClip::Create({wanted.kind, wanted.vertices, wanted.frames, 1}, clip));
    std::ostringstream name;
    name << kSynthKindNames[static_cast<std::size_t>(wanted.kind)] << ',' << clip.mesh().positions.size() << ','
         << clip.frames();
    for (const double quality : wanted.qualities) {
      EncoderSettings settings;
      settings.quality = quality;
      std::ostringstream text;
      text << "quality " << quality;
      SAC_RETURN_IF_ERROR(Measure(clip, name.str(), text.str(), settings, rows));
    }
    for (const double bound : wanted.bounds) {
      EncoderSettings settings;
      settings.max_error = bound * BoundingBox(clip.mesh().positions).diagonal();
      std::ostringstream text;
      text << "max error " << bound << "d";
      SAC_RETURN_IF_ERROR(Measure(clip, name.str(), text.str(), settings, rows));
    }
  }
  return Status::Ok();
}

std::string FormatRates(const std::vector<RateRow>& rows) {
  std::ostringstream out;
  out << kHeader << '\n';
  for (const RateRow& row : rows) {
    out << row.name << ',' << row.bytes << ',' << std::setprecision(5) << row.kg << ',' << row.sted << '\n';
  }
  return out.str();
}

bool ParseRates(const std::string& text, std::vector<RateRow>& rows) {
  std::istringstream in(text);
  std::string line;
  if (!std::getline(in, line) || line != kHeader) return false;
  while (std::getline(in, line)) {
    // The last fields are the figures, all before them the name.
    std::size_t comma = line.size();
    for (std::size_t i = 0; i < kFigures && comma != std::string::npos && comma > 0; ++i) {
      comma = line.rfind(',', comma - 1);
    }
    if (comma == std::string::npos || comma == 0 || line.empty()) return false;
    RateRow row;
    row.name = line.substr(0, comma);
    if (std::count(row.name.begin(), row.name.end(), ',') != kNameCommas) return false;
    char first = 0, second = 0;
    std::istringstream figures(line.substr(comma + 1));
    figures >> row.bytes >> first >> row.kg >> second >> row.sted;
    if (!figures || !figures.eof() || first != ',' || second != ',' || !(row.kg >= 0 && row.sted >= 0)) return false;
    rows.push_back(row);
  }
  return true;
}

}  // namespace sac

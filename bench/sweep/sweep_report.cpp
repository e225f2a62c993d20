// SPDX-License-Identifier: Apache-2.0
#include "bench/sweep/sweep_report.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

#include "bench/sweep/bd_rate.h"
#include "bench/sweep/report_page.h"
#include "bench/sweep/result_file.h"
#include "cli/distortion_report.h"
#include "files/output_file.h"
#include "report/page.h"
#include "sac/version.h"

namespace sac {
namespace {

Status WriteText(const std::string& path, const std::string& text) {
  OutputFile file;
  SAC_RETURN_IF_ERROR(file.Open(path));
  SAC_RETURN_IF_ERROR(file.Write(text));
  return file.Commit();
}

// A value as a field of a CSV file (RFC 4180).
std::string CsvField(const Json& value) {
  if (value.is_null()) return "";
  if (!value.is_string()) return value.dump();
  std::string text = value;
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) text.insert(at, 1, '"');
  return '"' + text + '"';
}

std::string Csv(const Json& results) {
  const std::vector<std::string> columns{
      "clip",           "codec",        "setting",  "bytes",          "bpvf",         "kg",
      "sted",           "sted_s",       "sted_t",   "max_error",      "encode_cpu_s", "encode_s",
      "encode_peak_mb", "decode_cpu_s", "decode_s", "decode_peak_mb", "error"};
  std::string text;
  for (const std::string& column : columns) text += (text.empty() ? "" : ",") + column;
  text += "\r\n";
  for (const Json& result : results) {
    std::string line;
    for (const std::string& column : columns) {
      if (column != columns.front()) line += ',';
      if (result.contains(column)) line += CsvField(result[column]);
    }
    text += line + "\r\n";
  }
  return text;
}

std::vector<RatePoint> Curve(const Sweep& sweep, std::size_t clip, std::size_t codec,
                             double DistortionMetrics::*measure) {
  std::vector<RatePoint> points;
  for (const SweepResult& r : sweep.results) {
    if (r.clip == clip && r.codec == codec && r.error.empty()) points.push_back({r.bpvf, r.distortion.*measure});
  }
  return points;
}

Json BdRates(const Sweep& sweep) {
  Json rates = Json::array();
  for (std::size_t clip = 0; clip < sweep.clips.size(); ++clip) {
    for (std::size_t codec = 1; codec < sweep.codecs.size(); ++codec) {
      for (const auto& [name, measure] :
           {std::pair{"kg", &DistortionMetrics::kg}, {"sted", &DistortionMetrics::sted}}) {
        const auto rate = BjontegaardRate(Curve(sweep, clip, 0, measure), Curve(sweep, clip, codec, measure));
        Json entry;
        entry["clip"] = clip;
        entry["codec"] = codec;
        entry["measure"] = name;
        entry["percent"] = rate ? Json(rate->percent) : Json();
        entry["low"] = rate ? Json(rate->low) : Json();
        entry["high"] = rate ? Json(rate->high) : Json();
        rates.push_back(entry);
      }
    }
  }
  return rates;
}

Json ToJson(const Sweep& sweep) {
  Json json;
  json["version"] = SAC_VERSION_STRING;
  json["jobs"] = sweep.jobs;
  json["clips"] = Json::array();
  for (const SweepClip& clip : sweep.clips) {
    json["clips"].push_back({{"name", clip.name},
                             {"key", clip.key},
                             {"vertices", clip.vertices},
                             {"triangles", clip.triangles},
                             {"frames", clip.frames},
                             {"diagonal", clip.diagonal}});
  }
  json["codecs"] = Json::array();
  for (const SweepCodec& codec : sweep.codecs) {
    Json entry{{"name", codec.name}, {"title", codec.title}, {"version", codec.version}};
    if (!codec.missing.empty()) entry["missing"] = codec.missing;
    json["codecs"].push_back(entry);
  }
  json["results"] = Json::array();
  for (const SweepResult& r : sweep.results) {
    Json& result = json["results"].emplace_back(ToJson(sweep.clips[r.clip], sweep.codecs[r.codec], r));
    result["clip_index"] = r.clip;  // an index, since several clips may have the same name
  }
  json["bd_rates"] = BdRates(sweep);
  return json;
}

// The KG errors, in percent, at which shapes are shown: of each curve the points nearest to these.
constexpr double kShownKg[] = {1, 0.1};

std::vector<std::size_t> ShownResults(const Sweep& sweep, std::size_t clip) {
  std::vector<std::size_t> shown;
  for (std::size_t codec = 0; codec < sweep.codecs.size(); ++codec) {
    for (const double kg : kShownKg) {
      double least = std::numeric_limits<double>::infinity();
      std::size_t nearest = sweep.results.size();
      for (std::size_t i = 0; i < sweep.results.size(); ++i) {
        const SweepResult& r = sweep.results[i];
        if (r.clip != clip || r.codec != codec || !r.error.empty()) continue;
        const double distance = std::abs(std::log(std::max(r.distortion.kg, 1e-9) / kg));
        if (distance < least) nearest = i;
        least = std::min(least, distance);
      }
      if (nearest < sweep.results.size() && (shown.empty() || shown.back() != nearest)) shown.push_back(nearest);
    }
  }
  return shown;
}

// Makes the shapes of a clip as JSON: {box, vertices, triangles, frames, original, decoded: [{result, samples}...]},
// with arrays of numbers as base64.
Status ShapesOf(const Sweep& sweep, std::size_t index, Json& json) {
  const SweepClip& clip = sweep.clips[index];
  DisplayBox box;
  SAC_RETURN_IF_ERROR(MeasureDisplayBox(clip.cache_path, clip.display, box));
  std::string original;
  SAC_RETURN_IF_ERROR(SampleShapes(clip.cache_path, clip.display, box, original));
  std::string triangles;
  for (const auto& triangle : clip.display.triangles) {
    for (const std::uint16_t v : triangle) {
      triangles += static_cast<char>(v & 255);
      triangles += static_cast<char>(v >> 8);
    }
  }
  json["low"] = box.low;
  json["high"] = box.high;
  json["vertices"] = clip.display.vertices.size();
  json["frames"] = clip.display.frames;
  json["triangles"] = Base64(triangles);
  json["original"] = Base64(original);
  json["decoded"] = Json::array();
  for (const std::size_t i : ShownResults(sweep, index)) {
    std::ifstream file(sweep.results[i].samples_path, std::ios::binary);
    const std::string samples{std::istreambuf_iterator<char>(file), {}};
    if (samples.size() != original.size() / 6 * 7) {
      return Status::Corrupt(sweep.results[i].samples_path + ": not what was written; remove it and sweep again");
    }
    json["decoded"].push_back({{"result", i}, {"samples", Base64(samples)}});
  }
  return Status::Ok();
}

}  // namespace

Status WriteReport(const Sweep& sweep, const std::string& directory) {
  Json json = ToJson(sweep);
  SAC_RETURN_IF_ERROR(WriteText(directory + "/sweep.csv", Csv(json["results"])));
  SAC_RETURN_IF_ERROR(
      WriteText(directory + "/sweep.json", json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n'));
  for (std::size_t clip = 0; clip < sweep.clips.size(); ++clip) {
    SAC_RETURN_IF_ERROR(ShapesOf(sweep, clip, json["clips"][clip]["shapes"]));
  }
  return WriteText(directory + "/sweep.html", ReportPage(JsonLine(json)));
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "bench/sweep/result_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "files/output_file.h"

namespace sac {
namespace {

double NumberOr(const Json& json, const char* name, double otherwise) {
  const auto found = json.find(name);
  return found != json.end() && found->is_number() ? found->get<double>() : otherwise;
}

DistortionMetrics DistortionOf(const Json& json) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();  // stands as null in JSON
  DistortionMetrics metrics;
  metrics.kg = NumberOr(json, "kg", kInfinity);
  metrics.sted = NumberOr(json, "sted", kInfinity);
  metrics.sted_s = NumberOr(json, "sted_s", kInfinity);
  metrics.sted_t = NumberOr(json, "sted_t", kInfinity);
  metrics.max_error = NumberOr(json, "max_error", kInfinity);
  return metrics;
}

void AddUsage(const ProcessUsage& usage, const std::string& prefix, Json& json) {
  json[prefix + "_cpu_s"] = usage.cpu_seconds;
  json[prefix + "_s"] = usage.seconds;
  json[prefix + "_peak_mb"] = usage.peak_mb;
}

ProcessUsage UsageOf(const Json& json, const std::string& prefix) {
  ProcessUsage usage;
  usage.cpu_seconds = NumberOr(json, (prefix + "_cpu_s").c_str(), 0);
  usage.seconds = NumberOr(json, (prefix + "_s").c_str(), 0);
  usage.peak_mb = NumberOr(json, (prefix + "_peak_mb").c_str(), 0);
  return usage;
}

}  // namespace

Json ToJson(const SweepClip& clip, const SweepCodec& codec, const SweepResult& result) {
  Json json;
  json["clip"] = clip.name;
  json["codec"] = codec.name;
  json["setting"] = codec.settings[result.setting].name;
  if (!result.error.empty()) {
    json["error"] = result.error;
    return json;
  }
  json["key"] = result.key;
  json["bytes"] = result.bytes;
  json["bpvf"] = result.bpvf;
  AddDistortion(result.distortion, json);
  AddUsage(result.encode, "encode", json);
  AddUsage(result.decode, "decode", json);
  return json;
}

Status WriteResult(const std::string& path, const SweepClip& clip, const SweepCodec& codec, const SweepResult& result) {
  OutputFile file;
  SAC_RETURN_IF_ERROR(file.Open(path));
  SAC_RETURN_IF_ERROR(file.Write(JsonLine(ToJson(clip, codec, result))));
  return file.Commit();
}

bool ReadResult(const std::string& path, SweepResult& result) {
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const Json json = Json::parse(text, nullptr, false);
  std::error_code error;
  if (!json.is_object() || !json.contains("bytes") || !json["bytes"].is_number_unsigned()) return false;
  if (!std::filesystem::is_regular_file(result.samples_path, error)) return false;
  result.bytes = json["bytes"];
  result.bpvf = NumberOr(json, "bpvf", 0);
  result.distortion = DistortionOf(json);
  result.encode = UsageOf(json, "encode");
  result.decode = UsageOf(json, "decode");
  return true;
}

bool ReadDistortion(const std::string& text, DistortionMetrics& metrics) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("kg")) return false;
  metrics = DistortionOf(json);
  return true;
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include "bench/sweep/sweep_codec.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/sweep/child_process.h"
#include "bench/sweep/content_key.h"
#include "cli/program.h"
#include "sac/version.h"

namespace sac {
namespace {

namespace fs = std::filesystem;

std::string FindProgram(const std::string& program, const std::string& directory) {
  const fs::path here = fs::path(ThisProgram()).parent_path();
  std::vector<fs::path> places{here, here / "../peers"};
  if (!directory.empty()) places = {fs::absolute(directory)};
  for (const fs::path& place : places) {
    std::error_code error;
    if (fs::is_regular_file(place / program, error)) return fs::weakly_canonical(place / program).string();
  }
  return "";
}

std::vector<std::string> Words(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

// Reads the output of `PROGRAM describe`: {"title", "version", "parameter", "settings": [text...]}, or {"title",
// "missing"}.
void ReadDescription(const std::string& text, SweepCodec& codec) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("title") || !json["title"].is_string()) {
    codec.missing = codec.program + ": says nothing of itself";
    return;
  }
  codec.title = json["title"];
  codec.version = json.value("version", "");
  codec.missing = json.value("missing", "");
  if (!codec.missing.empty()) return;
  const std::string parameter = json.value("parameter", "setting");
  for (const nlohmann::json& setting : json.value("settings", nlohmann::json::array())) {
    if (!setting.is_string()) continue;
    const std::string value = setting;
    codec.settings.push_back({parameter.empty() ? value : parameter + " " + value, {"--setting", value}});
  }
  if (codec.settings.empty()) codec.missing = codec.program + ": has no settings";
}

}  // namespace

const std::vector<std::string>& PeerNames() {
  static const std::vector<std::string> names{"sac2015", "pca",   "draco", "draco-animation", "meshopt", "gltfpack",
                                              "zfp",     "fpzip", "xz"};
  return names;
}

Status SacCodecs(const std::string& program, const std::vector<std::string>& qualities,
                 const std::vector<std::string>& max_errors, const std::vector<std::string>& variants,
                 std::vector<SweepCodec>& codecs) {
  SweepCodec sac;
  sac.version = SAC_VERSION_STRING;
  sac.program = program;
  SAC_RETURN_IF_ERROR(KeyOfFile(sac.program, sac.program_key));
  const auto add = [&](const std::string& name, const std::string& title, const std::string& what, const char* option,
                       const std::vector<std::string>& values, const char* unit, const std::string& more) {
    SweepCodec codec = sac;
    codec.name = name;
    codec.title = title;
    for (const std::string& value : values) {
      SweepCodec::Setting setting{what + " " + value + unit, {"--unchecked", option, value + unit}};
      for (const std::string& word : Words(more)) setting.options.push_back(word);
      codec.settings.push_back(setting);
    }
    if (!values.empty()) codecs.push_back(codec);
  };
  add("sac", "sac", "quality", "--quality", qualities, "", "");
  add("sac-bounded", "sac with a bound on the error", "max error", "--max-error", max_errors, "d", "");
  for (const std::string& variant : variants) {
    add("sac " + variant, "sac " + variant, "quality", "--quality", qualities, "", variant);
  }
  return Status::Ok();
}

SweepCodec FindPeer(const std::string& name, const std::string& directory) {
  SweepCodec codec;
  codec.name = codec.title = name;
  const std::string program = "sac-peer-" + name;
  codec.program = FindProgram(program, directory);
  if (codec.program.empty()) {
    codec.missing = "there is no program " + program + (directory.empty() ? " beside sac-sweep" : " in " + directory);
    return codec;
  }
  ProcessUsage usage;
  std::string text;
  Status status = KeyOfFile(codec.program, codec.program_key);
  if (status.ok()) status = RunProcess({codec.program, "describe"}, usage, text);
  if (status.ok()) {
    ReadDescription(text, codec);
  } else {
    codec.missing = status.message();
  }
  return codec;
}

}  // namespace sac

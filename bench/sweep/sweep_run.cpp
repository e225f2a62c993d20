// SPDX-License-Identifier: Apache-2.0
#include "bench/sweep/sweep_run.h"

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <thread>

#include "bench/sweep/content_key.h"
#include "bench/sweep/result_file.h"
#include "cli/distortion_report.h"
#include "cli/progress.h"
#include "files/output_file.h"

namespace sac {
namespace {

namespace fs = std::filesystem;

// A part of every result's key. Raise its number when figures are measured differently, so that old results are not
// used.
constexpr const char* kMeasurement = "sac sweep 1";

std::string KeyOf(const SweepClip& clip, const SweepCodec& codec, const SweepCodec::Setting& setting) {
  ContentKey key;
  for (const std::string& part : {std::string(kMeasurement), clip.key, codec.program_key}) key.Add(part);
  for (const std::string& option : setting.options) key.Add(option);
  return key.Text();
}

constexpr const char *kStream = ".stream", *kDecoded = ".decoded.pc2";

// The files that exist only while one setting is measured.
class Scratch {
 public:
  explicit Scratch(const std::string& stem) : stem_(stem) {}
  ~Scratch() {
    std::error_code ignored;
    for (const char* ending : {kStream, ".map", kDecoded, ".decoded.obj"}) fs::remove(stem_ + ending, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::string stream() const { return stem_ + kStream; }
  std::string map() const { return stem_ + ".map"; }
  std::string decoded() const { return stem_ + kDecoded; }

  Status KeepAs(const std::string& stem) const {
    std::error_code error;
    for (const char* ending : {kStream, kDecoded}) {
      fs::rename(stem_ + ending, stem + ending, error);
      if (error) return Status::IoError(stem + ending + ": " + error.message());
    }
    return Status::Ok();
  }

 private:
  std::string stem_;
};

// Measures the decoded clip in a process of its own, so that this process stays small (ForgetPeakMemory()).
Status Compare(const std::string& sac, const SweepClip& clip, const std::string& decoded, DistortionMetrics& metrics) {
  ProcessUsage usage;
  std::string text;
  SAC_RETURN_IF_ERROR(RunProcess(
      {sac, "compare", clip.mesh_path, clip.cache_path, "--with", clip.mesh_path, decoded, "--json"}, usage, text));
  if (!ReadDistortion(text, metrics)) return Status::Corrupt("sac compare: not understood: " + text);
  return Status::Ok();
}

Status Measure(const std::string& sac, const SweepClip& clip, const SweepCodec& codec,
               const SweepCodec::Setting& setting, const Scratch& files, SweepResult& result) {
  std::string ignored;
  std::vector<std::string> encode{codec.program, "encode",       clip.mesh_path, clip.cache_path,
                                  "-o",          files.stream(), "--order-map",  files.map()};
  encode.insert(encode.end(), setting.options.begin(), setting.options.end());
  SAC_RETURN_IF_ERROR(RunProcess(encode, result.encode, ignored));
  std::error_code error;
  result.bytes = fs::file_size(files.stream(), error);
  if (error) return Status::IoError(codec.program + ": wrote no stream");
  SAC_RETURN_IF_ERROR(
      RunProcess({codec.program, "decode", files.stream(), "-o", files.decoded(), "--order-map", files.map()},
                 result.decode, ignored));
  SAC_RETURN_IF_ERROR(Compare(sac, clip, files.decoded(), result.distortion));
  result.bpvf =
      8 * static_cast<double>(result.bytes) / (static_cast<double>(clip.vertices) * static_cast<double>(clip.frames));
  DisplayBox box;
  SAC_RETURN_IF_ERROR(MeasureDisplayBox(clip.cache_path, clip.display, box));
  std::string samples;
  SAC_RETURN_IF_ERROR(SampleShapes(files.decoded(), clip.display, box, samples));
  SAC_RETURN_IF_ERROR(SampleErrors(clip.cache_path, files.decoded(), clip.display, clip.diagonal, samples));
  OutputFile file;
  SAC_RETURN_IF_ERROR(file.Open(result.samples_path));
  SAC_RETURN_IF_ERROR(file.Write(samples));
  return file.Commit();
}

void PrintResult(const SweepClip& clip, const SweepCodec& codec, const SweepResult& result) {
  const std::string& setting = codec.settings[result.setting].name;
  if (!result.error.empty()) {
    std::printf("%s, %s, %s: %s\n", clip.name.c_str(), codec.name.c_str(), setting.c_str(), result.error.c_str());
  } else {
    std::printf("%s, %s, %s: %.4g bpvf, KG %.4g %%, STED %.4g, encoded in %.3g s, decoded in %.3g s\n",
                clip.name.c_str(), codec.name.c_str(), setting.c_str(), result.bpvf, result.distortion.kg,
                result.distortion.sted, result.encode.cpu_seconds, result.decode.cpu_seconds);
  }
  std::fflush(stdout);
}

std::vector<SweepResult> Plan(const std::vector<SweepClip>& clips, const std::vector<SweepCodec>& codecs) {
  std::vector<SweepResult> plan;
  for (std::size_t clip = 0; clip < clips.size(); ++clip) {
    for (std::size_t codec = 0; codec < codecs.size(); ++codec) {
      for (std::size_t setting = 0; setting < codecs[codec].settings.size(); ++setting) {
        SweepResult& result = plan.emplace_back();
        result.clip = clip;
        result.codec = codec;
        result.setting = setting;
      }
    }
  }
  return plan;
}

}  // namespace

Status RunSweep(const std::vector<SweepClip>& clips, const std::vector<SweepCodec>& codecs, const SweepPlaces& places,
                unsigned jobs, std::vector<SweepResult>& results) {
  results = Plan(clips, codecs);
  const std::string& sac = codecs.front().program;
  Progress progress;
  std::mutex printing;
  std::size_t done = 0;
  Status failure;  // a failure to store results, which is not an error of a codec
  const auto finish = [&](const SweepResult& result, bool is_new, const Status& stored) {
    const std::lock_guard lock(printing);
    progress.Begin("");
    if (is_new) PrintResult(clips[result.clip], codecs[result.codec], result);
    ++done;
    progress.Begin(std::to_string(done) + " of " + std::to_string(results.size()) + " measured");
    if (!stored.ok()) failure = stored;
  };
  const auto run = [&](SweepResult& result) {
    const SweepClip& clip = clips[result.clip];
    const SweepCodec& codec = codecs[result.codec];
    const SweepCodec::Setting& setting = codec.settings[result.setting];
    result.key = KeyOf(clip, codec, setting);
    const std::string stem = places.results + "/" + result.key, path = stem + ".json";
    result.samples_path = stem + ".samples";
    std::error_code ignored;
    const bool kept = !places.keep || (fs::exists(stem + kStream, ignored) && fs::exists(stem + kDecoded, ignored));
    if (kept && ReadResult(path, result)) return finish(result, false, Status::Ok());
    // The files are named by the result's number, since two results may have the same key: when a clip is given twice
    // or peers are links to one program.
    const Scratch files(places.work + "/" + std::to_string(&result - results.data()));
    Status status = Measure(sac, clip, codec, setting, files, result);
    if (status.ok() && places.keep) status = files.KeepAs(stem);
    result.error = status.message();
    finish(result, true, status.ok() ? WriteResult(path, clip, codec, result) : Status::Ok());
  };
  std::atomic<std::size_t> next = 0;
  std::vector<std::thread> workers;
  for (unsigned w = 0; w < jobs; ++w) {
    workers.emplace_back([&] {
      for (std::size_t i; (i = next++) < results.size();) run(results[i]);
    });
  }
  for (std::thread& worker : workers) worker.join();
  return failure;
}

}  // namespace sac

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/checked_encoding.h"
#include "cli/commands.h"
#include "cli/distortion_report.h"
#include "cli/error_option.h"
#include "cli/number_option.h"
#include "files/cache_file.h"
#include "files/frame_rate.h"
#include "files/mesh_file.h"
#include "files/overwriting.h"

namespace sac {
namespace {

constexpr double kLeastTarget = 1e-6, kLargestTarget = 1e6;
constexpr double kLeastStep = 1e-9, kLargestStep = 1e9;

struct EncodeOptions {
  CheckedEncoding::Settings settings;
  std::optional<double> quality;
  std::string reference = "key";
  bool json = false;
};

Status CheckOptions(EncodeOptions& options) {
  CheckedEncoding::Settings& s = options.settings;
  if (s.encoder.keep_order && !s.order_map.empty()) {
    return Status::InvalidArgument("--keep-order and --order-map exclude each other");
  }
  if (s.output.empty()) return Status::InvalidArgument("--output: no name");
  if (s.order_map == "-") return Status::InvalidArgument("--order-map: must be a file");
  for (const std::string& path : {s.output, s.order_map}) {
    if (IsReadableMeshName(path) || IsCacheName(path)) {
      return Status::InvalidArgument(path + ": a mesh or a cache by its name, not a .sac stream or an order map");
    }
  }
  if (s.output == "-" && isatty(STDOUT_FILENO) == 1) {
    return Status::InvalidArgument("standard output is a terminal, which cannot show a stream");
  }
  if (s.targets.any()) {
    for (const auto& [name, given] : {std::pair{"--quality", options.quality.has_value()},
                                      {"--motion-step", s.encoder.motion_step.has_value()},
                                      {"--displacement-step", s.encoder.displacement_step.has_value()},
                                      {"--detail-step", s.encoder.detail_step.has_value()},
                                      {"--position-bits", s.encoder.position_bits.has_value()},
                                      {"--max-error", s.max_error.has_value()}}) {
      if (given) return Status::InvalidArgument(std::string(name) + " and a target exclude each other");
    }
  }
  if (options.quality) s.encoder.quality = *options.quality;
  if (options.reference == "previous") s.encoder.reference_shape = ReferenceShape::kPrevious;
  std::vector<std::string> outputs{s.output};
  if (!s.order_map.empty()) outputs.push_back(s.order_map);
  return CheckOverwriting(FilesOfInput(s.inputs), outputs);
}

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

Json ToJson(const EncodeOptions& options, const CheckedEncoding& encoding, double seconds) {
  const auto or_null = [](const auto& value) { return value ? Json(*value) : Json(); };
  const StreamInfo& info = encoding.info();
  Json json;
  for (const auto& [part, bytes] : Parts(encoding.parts())) json[part] = bytes;
  json["bytes"] = encoding.bytes();
  json["bpvf"] = 8 * static_cast<double>(encoding.bytes()) /
                 (static_cast<double>(info.vertices) * static_cast<double>(encoding.frames()));
  if (!options.settings.unchecked) AddDistortion(encoding.distortion(), json);
  json["frames"] = encoding.frames();
  json["vertices"] = info.vertices;
  json["triangles"] = info.triangles;
  json["harmonics"] = info.harmonics;
  json["seconds"] = seconds;
  if (options.settings.targets.any()) json["trials"] = encoding.trials();
  const EncoderSettings& encoder = encoding.encoder_settings();
  Json& settings = json["settings"];
  settings["target_kg"] = or_null(options.settings.targets.kg);
  settings["target_sted"] = or_null(options.settings.targets.sted);
  settings["target_bpvf"] = or_null(options.settings.targets.bpvf);
  settings["quality"] = encoder.quality;
  settings["fps"] = info.frame_rate_numerator == 0 ? Json() : Json(RateText(info));
  settings["harmonics"] = or_null(encoder.harmonics);  // null: from the quality
  settings["samples_per_harmonic"] = encoder.samples_per_harmonic;
  settings["group"] = encoder.group;
  settings["pyramid"] = encoder.low_delay ? 1 : encoder.pyramid;
  settings["low_delay"] = encoder.low_delay;
  settings["reference"] = options.reference;
  settings["motion_step"] = or_null(encoder.motion_step);
  settings["displacement_step"] = or_null(encoder.displacement_step);
  settings["detail_step"] = or_null(encoder.detail_step);
  settings["max_error"] = or_null(encoder.max_error);
  settings["position_bits"] = or_null(encoder.position_bits);
  settings["keep_order"] = encoder.keep_order;
  return json;
}

void PrintText(const Json& json, const CheckedEncoding& encoding, std::FILE* file) {
  const StreamInfo& info = encoding.info();
  const std::uint32_t frames = encoding.frames();
  const auto bytes = static_cast<double>(encoding.bytes());
  const double raw = 12 * static_cast<double>(info.vertices) * static_cast<double>(frames);
  std::fprintf(file, "%u frames, %u vertices, %u triangles\n", frames, info.vertices, info.triangles);
  std::fprintf(file, "%.0f bytes, 1 : %.1f of raw float32, %.4g bits a vertex and frame\n", bytes, raw / bytes,
               json["bpvf"].get<double>());
  for (const auto& [part, size] : Parts(encoding.parts())) {
    std::fprintf(file, "  %-12s %10lld bytes %5.1f %%\n", part, size, 100 * static_cast<double>(size) / bytes);
  }
  if (json.contains("kg")) PrintDistortion(encoding.distortion(), file);
  if (encoding.trials() > 0) {
    const EncoderSettings& s = encoding.encoder_settings();
    std::fprintf(
        file,
        "found in %u trials: --motion-step %.4g --displacement-step %.4g --detail-step %.4g --position-bits %.5g "
        "--harmonics %u\n",
        encoding.trials(), *s.motion_step, *s.displacement_step, *s.detail_step, *s.position_bits, *s.harmonics);
  }
  std::fprintf(file, "%.2f seconds\n", json["seconds"].get<double>());
}

Status Encode(const EncodeOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  CheckedEncoding encoding(options.settings);
  SAC_RETURN_IF_ERROR(encoding.Run());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (encoding.lost_texture_coordinates()) {
    std::fprintf(stderr, "sac: warning: %s: its texture coordinates cannot be coded, the stream has none\n",
                 options.settings.inputs.front().c_str());
  }
  std::FILE* file = IsStandardOutput(options.settings.output) ? stderr : stdout;
  const Json json = ToJson(options, encoding, seconds);
  if (options.json) {
    std::fputs(JsonLine(json).c_str(), file);
  } else {
    PrintText(json, encoding, file);
  }
  return Status::Ok();
}

void AddFrameRate(CLI::App& app, EncoderSettings& encoder) {
  const auto parse = [&encoder](const CLI::results_t& words) {
    FrameRate rate;
    if (!ParseFrameRate(words.front(), rate)) {
      throw CLI::ValidationError("--fps", "'" + words.front() + "' is no frame rate");
    }
    encoder.frame_rate_numerator = rate.numerator;
    encoder.frame_rate_denominator = rate.denominator;
    return true;
  };
  app.add_option("--fps", parse,
                 "frames a second: 24, 30000/1001, or 29.97, which is 30000/1001 [that of the input, if it has one]")
      ->option_text("RATE");
}

void AddOptions(CLI::App& app, EncodeOptions& o) {
  EncoderSettings& encoder = o.settings.encoder;
  app.add_option("INPUT", o.settings.inputs,
                 "a mesh and its point cache (mesh.obj clip.pc2, mesh.ply clip.mdd), or meshes one a frame, or a "
                 "pattern of them (frame_%04d.obj); .obj, .ply, .off, .stl, .om")
      ->required()
      ->option_text("...");
  app.add_option("-o,--output", o.settings.output, "the stream to write; - is standard output")
      ->required()
      ->option_text("FILE");
  AddNumber(app, "--quality", o.quality, 0.0, 100.0, "0 (smallest) to 100 (nearest to the input) [50]");
  RateTargets& targets = o.settings.targets;
  AddNumber(app, "--target-kg", targets.kg, kLeastTarget, kLargestTarget,
            "search for the smallest stream of at most this KG, percent: the clip is encoded 3 to 24 times");
  AddNumber(app, "--target-sted", targets.sted, kLeastTarget, kLargestTarget, "likewise of at most this STED");
  AddNumber(app, "--target-bpvf", targets.bpvf, kLeastTarget, kLargestTarget,
            "search for the best quality in at most so many bits a vertex and frame; with another target, fail where "
            "that takes more");
  AddFrameRate(app, encoder);
  AddNumber(app, "--harmonics", encoder.harmonics, 1u, Limits{}.expert.harmonics,
            "manifold harmonics over all components; time and memory grow with them [from the quality]");
  AddNumber(
      app, "--samples-per-harmonic", encoder.samples_per_harmonic, 0u, 64u,
      "radial functions a harmonic that the basis is computed from; 0 for exact harmonics, which start slowly [2]");
  AddNumber(app, "--group", encoder.group, 1u, Limits{}.expert.frames_per_group,
            "frames between points of random access [128]");
  CLI::Option* pyramid = AddNumber(app, "--pyramid", encoder.pyramid, 1u, Limits{}.expert.frames_per_group,
                                   "frames of a hierarchy of B-frames; 1 for P-frames only [16]");
  app.add_flag("--low-delay", encoder.low_delay, "P-frames only, each written as soon as it is read: for live streams")
      ->excludes(pyramid);
  app.add_option("--reference", o.reference,
                 "what motion is measured against: key, the first frame, or previous, the frame before [key]")
      ->check(CLI::IsMember(std::vector<std::string>{"key", "previous"}))
      ->option_text("SHAPE");
  AddNumber(app, "--motion-step", encoder.motion_step, kLeastStep, kLargestStep,
            "quantizer step of rotation and stretch, radians and strain [from the quality]");
  AddNumber(app, "--displacement-step", encoder.displacement_step, kLeastStep, kLargestStep,
            "quantizer step of displacement, as a fraction of the first frame's RMS radius [from the quality]");
  AddNumber(app, "--detail-step", encoder.detail_step, 0.0, kLargestStep,
            "quantizer step of local detail, as a fraction of the RMS radius; 0 for none [from the quality]");
  AddMaxError(app, o.settings.max_error);
  AddNumber(
      app, "--position-bits", encoder.position_bits, 1.0, 24.0,
      "log2 of the first frame's extent in steps, at edges of median length; may be a fraction [from the quality]");
  app.add_flag("!--no-index", encoder.index, "leave out where groups begin, which a stream of several ends with");
  AddNumber(app, "--repeat-start", encoder.repeat_start, 0u, 0xffffffffu,
            "header and first frame again before every so many groups, for those who join in the middle [never]");
  app.add_flag("--keep-order", encoder.keep_order, "put the order of the vertices in the stream");
  app.add_option("--order-map", o.settings.order_map,
                 "write the order of the vertices to a file, for decode --order-map")
      ->option_text("FILE");
  app.add_flag("--unchecked", o.settings.unchecked, "neither decode nor measure what is written: in half the time");
  app.add_flag("--json", o.json, "report sizes in bytes, distortion and settings as one JSON object");
}

}  // namespace

Command AddEncodeCommand(CLI::App& app) {
  auto options = std::make_shared<EncodeOptions>();
  CLI::App* command = app.add_subcommand(
      "encode", "Encode a clip. The stream is decoded as it is written, and measured against the input.");
  AddOptions(*command, *options);
  command->footer(
      "The report goes to standard output, or to standard error if the stream goes there. Without --keep-order or\n"
      "--order-map the decoded clip has its vertices in another order.\n\n"
      "Examples:\n"
      "  sac encode body.obj walk.pc2 -o walk.sac\n"
      "  sac encode frame_%04d.ply -o clip.sac --fps 29.97 --quality 70 --keep-order\n"
      "  sac encode body.obj walk.pc2 -o walk.sac --target-kg 1.2 --target-sted 0.05\n"
      "  sac encode body.obj walk.mdd -o - --low-delay | ssh host 'cat > walk.sac'\n");
  return {command, [options] { return CheckOptions(*options); }, [options] { return Encode(*options); }};
}

}  // namespace sac

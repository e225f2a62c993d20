// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/encoding_report.h"
#include "cli/encoding_warnings.h"
#include "cli/error_option.h"
#include "cli/number_option.h"
#include "cli/progress.h"
#include "cli/warning_report.h"
#include "files/alembic/alembic_clip.h"
#include "files/cache_file.h"
#include "files/clip_input.h"
#include "files/frame_rate.h"
#include "files/mesh_file.h"
#include "files/output_file.h"
#include "files/overwriting.h"
#include "files/vertex_order.h"
#include "geometry/bounding_box.h"
#include "sac/clip_encoder.h"

namespace sac {
namespace {

constexpr double kLeastTarget = 1e-6, kLargestTarget = 1e6;
constexpr double kLeastStep = 1e-9, kLargestStep = 1e9;
constexpr std::uint32_t kMostReferenceRounds = 16;

struct EncodeOptions {
  std::vector<std::string> inputs;  // as for ClipInput
  std::string output;               // `-` is standard output
  std::string order_map;            // the file for the order of the vertices; empty: none
  ClipEncoding encoding;
  std::optional<ErrorLength> max_error;  // becomes the encoder's
  std::optional<double> quality;
  std::string reference = "key";
  std::string gaps = "error";
  std::string up_axis;           // x, y or z; empty: not said
  std::string json_file;         // of the author; empty: none
  std::string animation, scene;  // of a file that holds several
  bool json = false, strict = false, skip_damage = false;
};

// Reads what the options say of the clip into the encoder's metadata.
Status TakeMetadata(EncodeOptions& options) {
  Metadata& metadata = options.encoding.encoder.metadata;
  if (!options.up_axis.empty()) metadata.up_axis = static_cast<std::uint8_t>(options.up_axis[0] - 'x');
  if (options.json_file.empty()) return Status::Ok();
  std::ifstream file(options.json_file, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) return Status::IoError(options.json_file + ": cannot be read");
  if (!nlohmann::json::accept(text.str())) return Status::InvalidArgument(options.json_file + ": not JSON");
  metadata.json = text.str();
  return Status::Ok();
}

Status CheckOptions(EncodeOptions& options) {
  EncoderSettings& encoder = options.encoding.encoder;
  if (encoder.keep_order && !options.order_map.empty()) {
    return Status::InvalidArgument("--keep-order and --order-map exclude each other");
  }
  if (options.output.empty()) return Status::InvalidArgument("--output: no name");
  if (options.order_map == "-") return Status::InvalidArgument("--order-map: must be a file");
  for (const std::string& path : {options.output, options.order_map}) {
    if (IsReadableMeshName(path) || IsCacheName(path) || IsAlembicName(path)) {
      return Status::InvalidArgument(path + ": a mesh or a cache by its name, not a .sac stream or an order map");
    }
  }
  if (options.output == "-" && isatty(STDOUT_FILENO) == 1) {
    return Status::InvalidArgument("standard output is a terminal, which cannot show a stream");
  }
  if (options.encoding.targets.any()) {
    for (const auto& [name, given] : {std::pair{"--quality", options.quality.has_value()},
                                      {"--motion-step", encoder.motion_step.has_value()},
                                      {"--displacement-step", encoder.displacement_step.has_value()},
                                      {"--detail-step", encoder.detail_step.has_value()},
                                      {"--position-bits", encoder.position_bits.has_value()},
                                      {"--max-error", options.max_error.has_value()}}) {
      if (given) return Status::InvalidArgument(std::string(name) + " and a target exclude each other");
    }
  }
  if (options.quality) encoder.quality = *options.quality;
  SAC_RETURN_IF_ERROR(TakeMetadata(options));
  if (options.reference == "previous") encoder.reference_shape = ReferenceShape::kPrevious;
  std::vector<std::string> outputs{options.output};
  if (!options.order_map.empty()) outputs.push_back(options.order_map);
  return CheckOverwriting(FilesOfInput(options.inputs), outputs);
}

Status AtInput(const EncodeOptions& options, const std::string& message) {
  return Status::InvalidArgument(options.inputs.front() + ": " + message);
}

// A bound in diagonals becomes one in model units.
Status TakeMaxError(const EncodeOptions& options, const Mesh& mesh, EncoderSettings& encoder) {
  if (!options.max_error) return Status::Ok();
  const double diagonal = BoundingBox(mesh.positions).diagonal();
  if (options.max_error->in_diagonals && diagonal == 0) {
    return AtInput(options, "its first frame is a single point: --max-error needs model units");
  }
  encoder.max_error = options.max_error->value * (options.max_error->in_diagonals ? diagonal : 1);
  return Status::Ok();
}

// The files get their names at the end. Every message names a file.
Status EncodeFiles(const EncodeOptions& options, EncodedClip& encoded, Warnings& warnings) {
  Progress progress;
  progress.Begin("harmonics");
  std::unique_ptr<ClipInput> input;
  ClipInputSettings reading;
  reading.gaps = options.gaps == "hold" ? Gaps::kHold : options.gaps == "skip" ? Gaps::kSkip : Gaps::kError;
  reading.skip_damage = options.skip_damage;
  reading.rate = {options.encoding.encoder.frame_rate_numerator, options.encoding.encoder.frame_rate_denominator};
  reading.animation = options.animation;
  reading.scene = options.scene;
  reading.segments = true;
  SAC_RETURN_IF_ERROR(ClipInput::Open(options.inputs, input, reading));
  if (options.strict) SAC_RETURN_IF_ERROR(TellWarnings(input->warnings(), true));  // better now than after the encoding
  ClipEncoding encoding = options.encoding;
  encoding.encoder.offset = input->offset();
  SAC_RETURN_IF_ERROR(TakeMaxError(options, input->mesh(), encoding.encoder));
  const double diagonal = BoundingBox(input->mesh().positions).diagonal();
  // A stream that ends early is worth more than none, but not more than the file that is there.
  std::error_code ignored;
  const bool keeps_part =
      !options.strict && (options.output == "-" || !std::filesystem::exists(options.output, ignored));
  // The outputs before the harmonics, which take long.
  OutputFile stream, order_map;
  SAC_RETURN_IF_ERROR(stream.Open(options.output));
  if (!options.order_map.empty()) SAC_RETURN_IF_ERROR(order_map.Open(options.order_map));
  progress.SetTotal(input->frame_count());
  encoding.progress = [&progress](const EncodingProgress& p) {
    progress.SetPass(p.trial > 0 ? "trial " + std::to_string(p.trial) + ", " : "");
    if (p.frames > 0) progress.FramesDone(p.frames);
    return true;
  };
  const auto sink = [&stream](std::span<const std::uint8_t> bytes) { return stream.Write(bytes.data(), bytes.size()); };
  const Status coded = EncodeClip(*input, encoding, sink, encoded);
  if (!coded.ok() && (encoded.frames == 0 || !keeps_part)) return coded;
  warnings = input->warnings();
  if (coded.ok()) {
    for (std::string& line : EncodingWarnings(input->name(), encoding, encoded, diagonal)) {
      warnings.push_back(std::move(line));
    }
  }
  if (options.strict) SAC_RETURN_IF_ERROR(TellWarnings(warnings, true));
  if (!options.order_map.empty()) {
    if (encoded.segments > 1) return AtInput(options, "the mesh changes: --keep-order keeps the order of each mesh");
    SAC_RETURN_IF_ERROR(order_map.Write(FormatOrderMap(encoded.order)));
    SAC_RETURN_IF_ERROR(order_map.Close());  // the disk may be full
  }
  SAC_RETURN_IF_ERROR(stream.Commit());
  if (!options.order_map.empty()) SAC_RETURN_IF_ERROR(order_map.Commit());
  if (coded.ok()) return coded;
  return {coded.code(), coded.message() + "; " + (options.output == "-" ? "standard output" : options.output) +
                            " has the " + std::to_string(encoded.frames) + " frames before"};
}

Status Encode(const EncodeOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  EncodedClip encoded;
  Warnings warnings;
  const Status status = EncodeFiles(options, encoded, warnings);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.strict) SAC_RETURN_IF_ERROR(TellWarnings(warnings, false));
  SAC_RETURN_IF_ERROR(status);
  std::FILE* file = IsStandardOutput(options.output) ? stderr : stdout;
  if (options.json) {
    std::fputs(JsonLine(EncodingJson(options.encoding, encoded, warnings, seconds)).c_str(), file);
  } else {
    PrintEncoding(options.encoding, encoded, seconds, file);
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
  app.add_option(
         "--fps", parse,
         "frames a second: 24, 30000/1001, or 29.97, which is 30000/1001; scenes are sampled at it [that of the input, "
         "if it has one]")
      ->option_text("RATE");
}

void AddFiles(CLI::App& app, EncodeOptions& o) {
  app.add_option(
         "INPUT", o.inputs,
         "a mesh and its point cache (mesh.obj clip.pc2, mesh.ply clip.mdd), or meshes, one for each frame, or a "
         "pattern of them (frame_%04d.obj, frame_####.obj, frame_$F4.obj, or 'frame_*.obj' in quotes), or their "
         "directory; .obj, .ply, .off, .stl, .om; or a scene whose meshes become one: .glb, .gltf, .abc")
      ->required()
      ->option_text("...");
  app.add_option("-o,--output", o.output, "the stream to write; - is standard output")->required()->option_text("FILE");
  app.add_option(
         "--gaps", o.gaps,
         "what becomes of numbers that are missing in a sequence of meshes: error, hold (the frame before stands "
         "for them) or skip [error]")
      ->check(CLI::IsMember(std::vector<std::string>{"error", "hold", "skip"}))
      ->option_text("WHAT");
  app.add_flag("--skip-damage", o.skip_damage, "read the whole frames of a cache that is cut short");
  app.add_flag("--keep-order", o.encoding.encoder.keep_order, "put the order of the vertices in the stream");
  app.add_option("--order-map", o.order_map, "write the order of the vertices to a file, for decode --order-map")
      ->option_text("FILE");
  AddFrameRate(app, o.encoding.encoder);
  app.add_option("--animation", o.animation, "the animation of a .glb or .gltf to take, by name or number [the first]")
      ->option_text("NAME");
  app.add_option("--scene", o.scene, "the scene of a .glb or .gltf to take, by name or number [the one it shows]")
      ->option_text("NAME");
}

void AddTargets(CLI::App& app, EncodeOptions& o) {
  RateTargets& targets = o.encoding.targets;
  AddNumber(app, "--quality", o.quality, 0.0, 100.0, "0 (smallest stream) to 100 (nearest to the input) [50]");
  AddNumber(app, "--target-kg", targets.kg, kLeastTarget, kLargestTarget,
            "search for the smallest stream whose KG is at most this, in percent: the clip is encoded 3 to 24 times");
  AddNumber(app, "--target-sted", targets.sted, kLeastTarget, kLargestTarget,
            "search for the smallest stream whose STED is at most this, also together with --target-kg");
  AddNumber(app, "--target-bpvf", targets.bpvf, kLeastTarget, kLargestTarget,
            "search for the best quality in at most this many bits per vertex and frame; with another target, fail "
            "where the smallest stream takes more");
  AddMaxError(app, o.max_error);
}

void AddSteps(CLI::App& app, EncoderSettings& encoder) {
  AddNumber(app, "--harmonics", encoder.harmonics, 1u, Limits{}.expert.harmonics,
            "manifold harmonics over all components; time and memory grow with them [from the quality]");
  AddNumber(app, "--handles-per-harmonic", encoder.handles_per_harmonic, 0u, 64u,
            "handles for each harmonic, which the mesh follows, but no more than 800 unless that is below one; 0 for "
            "every vertex a handle, which is slow [2]");
  AddNumber(app, "--motion-step", encoder.motion_step, kLeastStep, kLargestStep,
            "quantizer step of rotation and stretch, in radians and strain [from the quality]");
  AddNumber(app, "--displacement-step", encoder.displacement_step, kLeastStep, kLargestStep,
            "quantizer step of displacement, as a fraction of the mesh's RMS radius [from the quality]");
  AddNumber(app, "--detail-step", encoder.detail_step, 0.0, kLargestStep,
            "quantizer step of local detail, as a fraction of the RMS radius; 0 for none [from the quality]");
  AddNumber(app, "--position-bits", encoder.position_bits, 1.0, 24.0,
            "log2 of the mesh's extent in steps, at edges of median length; may be a fraction [from the "
            "quality]");
}

void AddStructure(CLI::App& app, EncodeOptions& o) {
  EncoderSettings& encoder = o.encoding.encoder;
  AddNumber(app, "--group", encoder.group, 1u, Limits{}.expert.frames_per_group,
            "frames between points of random access [128]");
  CLI::Option* pyramid = AddNumber(app, "--pyramid", encoder.pyramid, 1u, Limits{}.expert.frames_per_group,
                                   "frames of a hierarchy of B-frames; 1 for P-frames only [16]");
  app.add_flag("--low-delay", encoder.low_delay, "P-frames only, each written as soon as it is read: for live streams")
      ->excludes(pyramid);
  app.add_option(
         "--reference", o.reference,
         "what motion is measured against: key, one shape near the first frame, or previous, the frame before [key]")
      ->check(CLI::IsMember(std::vector<std::string>{"key", "previous"}))
      ->option_text("SHAPE");
  AddNumber(
      app, "--reference-rounds", o.encoding.reference_rounds, 0u, kMostReferenceRounds,
      "fit that shape to all frames in N rounds, and use it where the clip costs less; encoding takes 2 to 3 times "
      "as long, with targets N trials more; 0 for the first frame, as with --max-error, --low-delay and "
      "--reference previous [2, with --unchecked 0]");
  app.add_flag("!--no-index", encoder.index,
               "leave out the index of groups, with which a stream of several groups ends; players seek by it");
  app.add_flag_callback(
      "--no-join", [&encoder] { encoder.join = false; },
      "code vertices apart that coincide in all frames: seams between them may open");
  AddNumber(
      app, "--base-levels", encoder.base_levels, 0u, 32u,
      "code groups in layers that sac thin can drop: N levels of the pyramid in the first, then the others one by "
      "one, then detail; 0 for no layers [0]");
  AddNumber(app, "--repeat-start", encoder.repeat_start, 0u, 0xffffffffu,
            "write header and first frame again before every N groups, for those who join in the middle [never]");
}

void AddMetadata(CLI::App& app, EncodeOptions& o) {
  Metadata& metadata = o.encoding.encoder.metadata;
  app.add_option("--name", metadata.name, "what the clip is called, for those who read the stream")
      ->option_text("TEXT");
  app.add_option("--metadata", o.json_file, "a JSON file to be carried in the stream")->option_text("FILE");
  AddNumber(app, "--metres-per-unit", metadata.metres_per_unit, kLeastStep, kLargestStep, "the length of a model unit");
  app.add_option("--up-axis", o.up_axis, "the axis that points up: x, y or z")
      ->check(CLI::IsMember(std::vector<std::string>{"x", "y", "z"}))
      ->option_text("AXIS");
  AddNumber(app, "--first-frame", metadata.first_frame, std::int32_t{-2147483647}, std::int32_t{2147483647},
            "the author's number of the first frame");
  app.add_flag_callback(
      "--loop", [&metadata] { metadata.loops = true; }, "say that the clip is made to be looped");
  app.add_flag("--bounds", o.encoding.encoder.bounds,
               "say where the clip and each group are, at the end of the stream");
}

void AddReport(CLI::App& app, EncodeOptions& o) {
  app.add_flag("!--unchecked", o.encoding.measure,
               "neither decode nor measure what is written, nor fit the reference shape; takes a fifth of the time, "
               "and tells nothing of errors");
  AddStrict(app, o.strict);
  app.add_flag("--json", o.json, "report sizes in bytes, distortion, settings and warnings as one JSON object");
}

}  // namespace

Command AddEncodeCommand(CLI::App& app) {
  auto options = std::make_shared<EncodeOptions>();
  CLI::App* command = app.add_subcommand(
      "encode", "Encode a clip. The stream is decoded as it is written, and measured against the input.");
  AddFiles(*command, *options);
  AddTargets(*command, *options);
  AddSteps(*command, options->encoding.encoder);
  AddStructure(*command, *options);
  AddMetadata(*command, *options);
  AddReport(*command, *options);
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

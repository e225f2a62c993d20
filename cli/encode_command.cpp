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

#include "cli/clip_part_reader.h"
#include "cli/commands.h"
#include "cli/distortion_report.h"
#include "cli/encode_options.h"
#include "cli/encoding_report.h"
#include "cli/encoding_warnings.h"
#include "cli/error_option.h"
#include "cli/progress.h"
#include "cli/warning_report.h"
#include "files/alembic/alembic_clip.h"
#include "files/cache_file.h"
#include "files/clip_input.h"
#include "files/mesh_file.h"
#include "files/output_file.h"
#include "files/overwriting.h"
#include "files/vertex_order.h"
#include "geometry/bounding_box.h"
#include "sac/clip_encoder.h"
#include "sac/encoder.h"

namespace sac {
namespace {

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
  if (options.start_only && options.encoding.targets.any()) {
    return Status::InvalidArgument("--start-only: a search for targets needs the whole stream");
  }
  if (options.start_only && options.encoding.reference_rounds.value_or(0) > 0) {
    return Status::InvalidArgument("--start-only: fitting the reference shape needs the whole stream");
  }
  std::vector<std::string> outputs{options.output};
  if (!options.order_map.empty()) outputs.push_back(options.order_map);
  std::vector<std::string> inputs = FilesOfInput(options.inputs);
  if (!options.from.empty()) inputs.push_back(options.from);
  return CheckOverwriting(inputs, outputs);
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

// Opens the input as the options say. `rate` is that of scenes.
Status OpenInput(const EncodeOptions& options, const FrameRate& rate, std::unique_ptr<ClipInput>& input) {
  ClipInputSettings reading;
  reading.gaps = options.gaps == "hold" ? Gaps::kHold : options.gaps == "skip" ? Gaps::kSkip : Gaps::kError;
  reading.skip_damage = options.skip_damage;
  reading.rate = rate;
  reading.animation = options.animation;
  reading.scene = options.scene;
  reading.segments = true;
  SAC_RETURN_IF_ERROR(ClipInput::Open(options.inputs, input, reading));
  // Better now than after the encoding.
  return options.strict ? TellWarnings(input->warnings(), true) : Status::Ok();
}

// Whether the part that was encoded ends where a group does.
Status CheckPartEnd(const EncodeOptions& options, const ClipPartReader& part, const EncodedClip& encoded) {
  if (!part.clip_goes_on() || encoded.frames % encoded.group_frames == 0) return Status::Ok();
  const std::uint32_t end = options.part.begin + encoded.frames, group = encoded.group_frames;
  return AtInput(options, "a part ends with a group, of which each has " + std::to_string(group) +
                              " frames, or with the clip: not before frame " + std::to_string(end) + " but before " +
                              std::to_string(end / group * group) + " or " + std::to_string((end / group + 1) * group));
}

// Writes what parts are encoded from.
Status EncodeStartFile(const EncodeOptions& options) {
  std::unique_ptr<ClipInput> input;
  EncoderSettings settings = options.encoding.encoder;
  SAC_RETURN_IF_ERROR(OpenInput(options, {settings.frame_rate_numerator, settings.frame_rate_denominator}, input));
  settings.offset = input->offset();
  SAC_RETURN_IF_ERROR(TakeMaxError(options, input->mesh(), settings));
  if (settings.frame_rate_numerator == 0 && input->rate().numerator != 0) {
    settings.frame_rate_numerator = input->rate().numerator;
    settings.frame_rate_denominator = input->rate().denominator;
  }
  OutputFile file;
  SAC_RETURN_IF_ERROR(file.Open(options.output));
  std::unique_ptr<Encoder> encoder;
  LookAhead known;
  SAC_RETURN_IF_ERROR(ReadAhead(*input, settings, known));
  settings.join = false;  // but for those that are known to coincide
  if (const Status s = Encoder::Create(input->mesh(), settings, encoder, known.lowest, known.reach); !s.ok()) {
    return AtInput(options, s.message());
  }
  const std::vector<std::uint8_t> start = encoder->start();
  SAC_RETURN_IF_ERROR(file.Write(start.data(), start.size()));
  SAC_RETURN_IF_ERROR(file.Commit());
  SAC_RETURN_IF_ERROR(TellWarnings(input->warnings(), options.strict));
  std::FILE* const report = IsStandardOutput(options.output) ? stderr : stdout;
  if (options.json) {
    const Json json = {{"bytes", start.size()},
                       {"vertices", encoder->info().vertices},
                       {"triangles", encoder->info().triangles},
                       {"harmonics", encoder->info().harmonics},
                       {"group_frames", encoder->group_frames()}};
    std::fputs(JsonLine(json).c_str(), report);
  } else {
    std::fprintf(report, "%s: %zu bytes, %u vertices, groups of %u frames\n", options.output.c_str(), start.size(),
                 encoder->info().vertices, encoder->group_frames());
  }
  return Status::Ok();
}

// The files get their names at the end. Every message names a file.
Status EncodeFiles(const EncodeOptions& options, EncodedClip& encoded, Warnings& warnings) {
  Progress progress;
  progress.Begin("harmonics");
  std::unique_ptr<ClipInput> input;
  ClipEncoding encoding = options.encoding;
  FrameRate rate = {encoding.encoder.frame_rate_numerator, encoding.encoder.frame_rate_denominator};
  if (!options.from.empty()) {
    SAC_RETURN_IF_ERROR(ReadStartFile(options.from, encoding.part.emplace().start, rate));
    encoding.part->first_frame = options.part.begin;
  }
  SAC_RETURN_IF_ERROR(OpenInput(options, rate, input));
  ClipPartReader part(*input, options.part);
  ClipReader& clip = encoding.part ? static_cast<ClipReader&>(part) : *input;
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
  progress.SetTotal(clip.frame_count());
  encoding.progress = [&progress](const EncodingProgress& p) {
    progress.SetPass(p.trial > 0 ? "trial " + std::to_string(p.trial) + ", " : "");
    if (p.frames > 0) progress.FramesDone(p.frames);
    return true;
  };
  const auto sink = [&stream](std::span<const std::uint8_t> bytes) { return stream.Write(bytes.data(), bytes.size()); };
  const Status coded = EncodeClip(clip, encoding, sink, encoded);
  if (encoding.part) SAC_RETURN_IF_ERROR(coded.ok() ? CheckPartEnd(options, part, encoded) : coded);
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
  if (options.start_only) return EncodeStartFile(options);
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

}  // namespace

Command AddEncodeCommand(CLI::App& app) {
  auto options = std::make_shared<EncodeOptions>();
  CLI::App* command = app.add_subcommand(
      "encode", "Encode a clip. The stream is decoded as it is written, and measured against the input.");
  AddEncodeOptions(*command, *options);
  command->footer(
      "The report goes to standard output, or to standard error if the stream goes there. Without --keep-order or\n"
      "--order-map the decoded clip has its vertices in another order.\n\n"
      "Examples:\n"
      "  sac encode body.obj walk.pc2 -o walk.sac\n"
      "  sac encode frame_%04d.ply -o clip.sac --fps 29.97 --quality 70 --keep-order\n"
      "  sac encode body.obj walk.pc2 -o walk.sac --target-kg 1.2 --target-sted 0.05\n"
      "  sac encode body.obj walk.mdd -o - --low-delay | ssh host 'cat > walk.sac'\n"
      "  sac encode body.obj walk.pc2 -o walk.start --start-only\n"
      "  sac encode body.obj walk.pc2 -o second.sac --from walk.start --part 128:256\n");
  return {command, [options] { return CheckOptions(*options); }, [options] { return Encode(*options); }};
}

}  // namespace sac

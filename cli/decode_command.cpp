// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/decoded_frames.h"
#include "cli/frame_range_option.h"
#include "cli/number_option.h"
#include "cli/progress.h"
#include "cli/warning_report.h"
#include "files/author_mesh.h"
#include "files/axes.h"
#include "files/cache_file.h"
#include "files/clip_output.h"
#include "files/mesh_file.h"
#include "files/overwriting.h"
#include "files/path.h"
#include "files/stream_input.h"
#include "files/vertex_order.h"

namespace sac {
namespace {

constexpr double kFpsOfUnknown = 24;

struct DecodeOptions {
  std::string input, output, order_map, onto;
  WantedFrames frames;
  std::int64_t first_number = 0;  // of the first frame, in the names of a sequence
  AxisConversion axes;
  ClipOutput::Compression compression = ClipOutput::Compression::kNone;
  bool exr = false, skip_damage = false, force = false, strict = false;
};

Status CheckOptions(const DecodeOptions& options) {
  if (!ClipOutput::IsClipName(options.output)) {
    return Status::InvalidArgument(ClipOutput::NameError(options.output));
  }
  if (options.order_map == "-" && options.input == "-") {
    return Status::InvalidArgument("standard input cannot be the stream and the order map");
  }
  if (!options.onto.empty() && !IsReadableMeshName(options.onto)) {
    return Status::InvalidArgument(options.onto + ": not a mesh file by its name (.obj, .ply, .off, .stl, .om)");
  }
  std::vector<std::string> inputs{options.input};
  for (const std::string& path : {options.order_map, options.onto}) {
    if (!path.empty()) inputs.push_back(path);
  }
  return CheckOverwriting(inputs, FilesOfOutput(options.output, options.exr));
}

class Decoding {
 public:
  explicit Decoding(const DecodeOptions& options) : options_(options) {}
  Status Run();

 private:
  Status OpenOutput(const Decoder& decoder);
  // The decoder's mesh in the order of what is written; order_ becomes that.
  Status TakeMesh(const Decoder& decoder, Mesh& mesh);
  // Goes on with the mesh of the next segment.
  Status BeginSegment(const Decoder& decoder, std::uint32_t frame);
  // Finds the author's mesh in the decoded one, which becomes the author's with the decoded positions.
  Status PutOnto(const Decoder& decoder, Mesh& mesh);
  // Frames before `index` that are lost get the positions of the one before, or of the next where none is.
  Status FillUpTo(std::uint32_t index, const Positions& next);
  Status Write(std::uint32_t index, const Positions& positions);
  Status Commit();

  const DecodeOptions& options_;
  VertexOrder order_;  // empty: as decoded
  AuthorMesh author_;  // with --onto
  std::unique_ptr<ClipOutput> output_;
  std::uint32_t written_ = 0;             // the frame after the last one written
  std::optional<std::uint32_t> segment_;  // of the frame that was decoded last
  Positions first_;                       // of the segment's first frame, which the normals belong to
  Positions last_;                        // with skip_damage
  Warnings lost_;
};

// Needs the decoded mesh.
Status Decoding::TakeMesh(const Decoder& decoder, Mesh& mesh) {
  mesh = *decoder.mesh();
  if (!first_.empty()) mesh.positions = first_;
  order_ = decoder.order();
  if (!options_.order_map.empty()) {
    SAC_RETURN_IF_ERROR(ReadOrderMap(options_.order_map, mesh.positions.size(), order_));
  }
  if (!options_.onto.empty()) {
    SAC_RETURN_IF_ERROR(PutOnto(decoder, mesh));
  } else if (!order_.empty()) {
    mesh = ToInputOrder(mesh, order_);
  }
  mesh = options_.axes.Convert(std::move(mesh));
  return Status::Ok();
}

Status Decoding::BeginSegment(const Decoder& decoder, std::uint32_t frame) {
  for (const auto& [option, file] : {std::pair{"--order-map", options_.order_map}, {"--onto", options_.onto}}) {
    if (!file.empty()) {
      return Status::Unsupported(file + ": " + option + " is for one mesh, and the mesh changes at frame " +
                                 std::to_string(frame));
    }
  }
  Mesh mesh;
  SAC_RETURN_IF_ERROR(TakeMesh(decoder, mesh));
  return output_->BeginMesh(frame, mesh);
}

Status Decoding::OpenOutput(const Decoder& decoder) {
  Mesh mesh;
  SAC_RETURN_IF_ERROR(TakeMesh(decoder, mesh));
  ClipOutput::Settings settings;
  if (author_.obj) settings.obj = &*author_.obj;
  settings.force = options_.force;
  settings.compression = options_.compression;
  settings.exr = options_.exr;
  settings.z_up = options_.axes.z_up();
  settings.fps = decoder.info()->frame_rate_numerator == 0 ? kFpsOfUnknown : decoder.info()->frames_per_second();
  settings.offset = options_.axes.Point(decoder.info()->offset);
  settings.precision = options_.axes.scale() * decoder.info()->position_step;
  // A pipe cannot be told the number at the end. Elsewhere it is not promised before the stream has shown as many.
  if (std::error_code error; options_.frames.end && std::filesystem::is_fifo(options_.output, error)) {
    settings.frame_count = *options_.frames.end - options_.frames.begin;
  }
  return ClipOutput::Open(options_.output, mesh, settings, output_);
}

Status Decoding::PutOnto(const Decoder& decoder, Mesh& mesh) {
  SAC_RETURN_IF_ERROR(OpenAuthorMesh(options_.onto, mesh, decoder.info()->offset, author_));
  order_ = author_.order;
  Positions positions = ToInputOrder(mesh.positions, order_);
  mesh = author_.file.mesh;
  mesh.positions = std::move(positions);
  const bool as_text = author_.obj && (IsCacheName(options_.output) || Extension(options_.output) == ".obj");
  if (!as_text && author_.file.faces.size() != mesh.triangles.size()) {
    author_.warnings.push_back(
        options_.output + ": the polygons of " + options_.onto +
        " are written as triangles; an .obj, or a cache with one beside it, keeps those of an .obj");
  }
  if (author_.obj && options_.axes.changes()) {
    Mesh normals;
    normals.normals = author_.obj->normals();
    author_.obj->ReplaceNormals(options_.axes.Convert(std::move(normals)).normals);
  }
  return Status::Ok();
}

Status Decoding::Write(std::uint32_t index, const Positions& positions) {
  written_ = index + 1;
  return output_->Write(index + options_.first_number,
                        options_.axes.Points(order_.empty() ? positions : ToInputOrder(positions, order_)));
}

Status Decoding::FillUpTo(std::uint32_t index, const Positions& next) {
  for (std::uint32_t lost = std::max(written_, options_.frames.begin); lost < index; ++lost) {
    SAC_RETURN_IF_ERROR(Write(lost, last_.empty() ? next : last_));
  }
  return Status::Ok();
}

Status Decoding::Run() {
  const std::filesystem::path directory = std::filesystem::path(options_.output).parent_path();
  if (std::error_code error; !directory.empty() && !std::filesystem::is_directory(directory, error)) {
    return Status::IoError(options_.output + ": no such directory");  // better now than after the harmonics
  }
  StreamInput input;
  SAC_RETURN_IF_ERROR(input.Open(options_.input));
  Progress progress(options_.frames.end);
  progress.Begin("harmonics");
  DecoderSettings settings;
  settings.skip_damage = options_.skip_damage;
  DecodedFrames frames(
      input.name(), [&input](auto& chunk) { return input.Read(chunk); }, settings);
  DecodedFrame frame;
  std::uint32_t count = 0;
  const WantedFrames& range = options_.frames;
  // What comes after the last frame wanted is not read.
  for (bool end = false; count != range.end;) {
    SAC_RETURN_IF_ERROR(frames.Next(frame, end));
    if (end) break;
    const bool is_next = frame.index == count;
    count = frame.index + 1;
    progress.FramesDone(count);
    const bool begins = segment_ != frame.segment;
    segment_ = frame.segment;
    if (begins) first_ = is_next ? frame.positions : Positions();
    if (frame.index < range.begin) continue;
    const bool changes = begins && output_;
    if (!output_) SAC_RETURN_IF_ERROR(OpenOutput(frames.decoder()));
    SAC_RETURN_IF_ERROR(FillUpTo(std::min(frame.index, range.end.value_or(frame.index)), frame.positions));
    if (changes && frame.index < range.end.value_or(count)) {
      SAC_RETURN_IF_ERROR(BeginSegment(frames.decoder(), frame.index));
    }
    if (frame.index < range.end.value_or(count)) SAC_RETURN_IF_ERROR(Write(frame.index, frame.positions));
    if (range.end && count > *range.end) count = *range.end;
    if (options_.skip_damage) last_ = std::move(frame.positions);
  }
  for (const FrameRange& lost : frames.decoder().lost_frames()) {
    lost_.push_back(input.name() + ": frames " + std::to_string(lost.first) + " to " +
                    std::to_string(lost.first + lost.count - 1) + " are lost; the frame before stands for them");
    if (const std::uint64_t after = std::uint64_t{lost.first} + lost.count; output_ && after > count) {
      count = static_cast<std::uint32_t>(std::min<std::uint64_t>(after, range.end.value_or(0xffffffffu)));
      SAC_RETURN_IF_ERROR(FillUpTo(count, last_));
    }
  }
  if (count == 0) return Status::InvalidArgument(input.name() + ": has no frames");
  if (!output_ || (range.end && count != *range.end)) {
    return Status::InvalidArgument(input.name() + ": --frames asks for frame " +
                                   std::to_string(output_ ? *range.end - 1 : range.begin) + ", the last one is " +
                                   std::to_string(count - 1));
  }
  return Commit();
}

Status Decoding::Commit() {
  Warnings warnings = lost_;
  warnings.insert(warnings.end(), author_.warnings.begin(), author_.warnings.end());
  for (std::string& warning : output_->warnings()) warnings.push_back(std::move(warning));
  // Who asks for some of the frames may have others there on purpose.
  if (options_.frames.begin == 0 && !options_.frames.end) {
    for (std::string& warning : output_->StaleFrames()) warnings.push_back(std::move(warning));
  }
  SAC_RETURN_IF_ERROR(TellWarnings(warnings, options_.strict));
  return output_->Commit();
}

void AddOnto(CLI::App& app, DecodeOptions& options) {
  CLI::Option* order_map =
      app.add_option("--order-map", options.order_map,
                     "order the vertices by the map that encode --order-map wrote (instead of the stream's own order)")
          ->option_text("FILE");
  app.add_option(
         "--onto", options.onto,
         "the mesh that the clip was made from: vertices come in its order, found by its faces and the first "
         "frame, and meshes have its faces; an .obj is written with its polygons, texture coordinates and names")
      ->option_text("MESH")
      ->excludes(order_map);
}

// The vertical axis and the unit of what is written.
void AddAxes(CLI::App& app, AxisConversion& axes) {
  const auto up = [&axes](const CLI::results_t& words) {
    if (axes.ParseUp(words.front())) return true;
    throw CLI::ValidationError("--up", "'" + words.front() + "' is neither y:z nor z:y");
  };
  app.add_option("--up", up, "turn what has y up so that z is up, y:z, or the other way round, z:y")
      ->option_text("FROM:TO");
  const auto units = [&axes](const CLI::results_t& words) {
    if (axes.ParseUnits(words.front())) return true;
    throw CLI::ValidationError("--units",
                               "'" + words.front() + "' is no pair of mm, cm, m, km, in, ft and yd such as cm:m");
  };
  app.add_option("--units", units, "scale from one unit of length to another: mm, cm, m, km, in, ft, yd")
      ->option_text("FROM:TO");
}

void AddCompression(CLI::App& app, ClipOutput::Compression& compression) {
  using Compression = ClipOutput::Compression;
  const auto parse = [&compression](const CLI::results_t& words) {
    for (const auto& [name, value] : {std::pair{"none", Compression::kNone},
                                      {"quantized", Compression::kQuantized},
                                      {"meshopt", Compression::kMeshopt}}) {
      if (words.front() == name) {
        compression = value;
        return true;
      }
    }
    throw CLI::ValidationError("--compress", "'" + words.front() + "' is none of none, quantized and meshopt");
  };
  app.add_option("--compress", parse,
                 "how a .glb or .gltf stores numbers: none, as floats; quantized, as integers, a third of the bytes; "
                 "meshopt, as integers that are compressed, which needs a player that knows EXT_meshopt_compression "
                 "[none]")
      ->option_text("HOW");
}

}  // namespace

Command AddDecodeCommand(CLI::App& app) {
  auto options = std::make_shared<DecodeOptions>();
  CLI::App* command = app.add_subcommand("decode", "Decode a stream into meshes or a point cache.");
  command->add_option("STREAM", options->input, "the stream to read; - is standard input")
      ->required()
      ->option_text(" ");
  command
      ->add_option("-o,--output", options->output,
                   "clip.pc2 or clip.mdd, with the mesh beside it as clip.obj; a pattern of meshes, frame_%04d.obj, "
                   ".ply or .off, one a frame; or a mesh for a single frame; or clip.abc; or clip.glb or clip.gltf, "
                   "with a morph "
                   "target for each frame; or clip.usda; or clip.vat, with textures for vertex shaders beside it")
      ->required()
      ->option_text("OUT");
  AddFrameRange(*command, "--frames", options->frames,
                "frames A up to but without B, from 0; A: to the end, :B from the first, A one frame [all]");
  AddOnto(*command, *options);
  command->add_flag("--skip-damage", options->skip_damage,
                    "go on after damage with the next group that is sound, and tell which frames are lost");
  AddNumber(*command, "--first-number", options->first_number, std::int64_t{-0x80000000LL}, std::int64_t{0xffffffffLL},
            "the number of frame 0 in the names of a sequence [0]");
  AddAxes(*command, options->axes);
  AddCompression(*command, options->compression);
  command->add_flag("--exr", options->exr, "textures of a .vat as OpenEXR of 32-bit floats, not as PNG of 16 bits");
  command->add_flag("--force", options->force, "replace files that are there beside the one to write");
  AddStrict(*command, options->strict);
  command->footer(
      "The vertices come in the order of the encoder's input if the stream keeps it, or a map or --onto gives it. MDD\n"
      "and scenes have times; where the stream has no frame rate they are those of 24 frames a second. Files get\n"
      "their names when all are complete. With --frames the stream is read up to the last frame wanted.\n\n"
      "Meshes have the normals of their frames, with the hard edges of the first: .obj alone can hold several at a\n"
      "vertex. An offset of the stream is added to the positions, in double precision; .pc2 and .mdd round the sum.\n\n"
      "Examples:\n"
      "  sac decode walk.sac -o walk.pc2\n"
      "  sac decode clip.sac -o frame_%04d.ply --frames 100:200\n"
      "  sac decode walk.sac --onto body.obj -o out.pc2\n"
      "  sac decode clip.sac -o poster.obj --frames 17 --order-map clip.order\n");
  return {command, [options] { return CheckOptions(*options); }, [options] { return Decoding(*options).Run(); }};
}

}  // namespace sac

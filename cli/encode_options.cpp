// SPDX-License-Identifier: Apache-2.0
#include "cli/encode_options.h"

#include <cstdint>

#include "cli/number_option.h"
#include "cli/warning_report.h"
#include "files/frame_rate.h"

namespace sac {
namespace {

constexpr double kLeastTarget = 1e-6, kLargestTarget = 1e6;
constexpr double kLeastStep = 1e-9, kLargestStep = 1e9;
constexpr std::uint32_t kMostReferenceRounds = 16;

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

void AddParts(CLI::App& app, EncodeOptions& o) {
  CLI::Option* start_only =
      app.add_flag("--start-only", o.start_only,
                   "write not the stream but its start, from which --from encodes parts of the clip, on any machine");
  CLI::Option* from = app.add_option("--from", o.from,
                                     "encode a part of a clip from the start that --start-only wrote, "
                                     "which says how: a stream that sac join puts to the others")
                          ->option_text("START")
                          ->excludes(start_only);
  AddFrameRange(app, "--part", o.part,
                "which frames: A up to but without B, whole groups or to the end of the clip [all]")
      ->needs(from);
  for (const char* name : {"--quality",
                           "--target-kg",
                           "--target-sted",
                           "--target-bpvf",
                           "--max-error",
                           "--harmonics",
                           "--handles-per-harmonic",
                           "--motion-step",
                           "--displacement-step",
                           "--detail-step",
                           "--position-bits",
                           "--group",
                           "--pyramid",
                           "--low-delay",
                           "--reference",
                           "--reference-rounds",
                           "--base-levels",
                           "--fps",
                           "--keep-order",
                           "--bounds"}) {
    from->excludes(app.get_option(name));
  }
  for (const char* name : {"--low-delay", "--bounds", "--order-map"}) start_only->excludes(app.get_option(name));
}

void AddReport(CLI::App& app, EncodeOptions& o) {
  app.add_flag("!--unchecked", o.encoding.measure,
               "neither decode nor measure what is written, nor fit the reference shape; takes a fifth of the time, "
               "and tells nothing of errors");
  AddNumber(
      app, "--jobs", o.encoding.encoder.threads, 0u, 1024u,
      "groups that are coded at the same time, whose frames are held then; the stream is the same with any number; "
      "0 for as many as the machine has processors [0]");
  AddStrict(app, o.strict);
  app.add_flag("--json", o.json, "report sizes in bytes, distortion, settings and warnings as one JSON object");
}

}  // namespace

void AddEncodeOptions(CLI::App& app, EncodeOptions& options) {
  AddFiles(app, options);
  AddTargets(app, options);
  AddSteps(app, options.encoding.encoder);
  AddStructure(app, options);
  AddMetadata(app, options);
  AddParts(app, options);
  AddReport(app, options);
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/clip_argument.h"
#include "cli/commands.h"
#include "cli/given_option.h"
#include "cli/number_option.h"
#include "cli/posed_output.h"
#include "cli/warning_report.h"
#include "files/cache_file.h"
#include "files/component_file.h"
#include "files/component_tables.h"
#include "files/overwriting.h"
#include "files/vat_writer.h"
#include "sac/component_poser.h"

namespace sac {
namespace {

// `7=2`: a component, by its number or its name, and a number.
struct Assignment {
  std::string component;
  double value;
};

struct PoseOptions {
  std::string components, weights, drag, output;
  std::vector<std::string> clip, gains, offsets, curves;
  std::optional<std::uint32_t> frame;
  std::optional<double> price;
  double quality = 50;
  bool many = false, bounded = false, no_track = false, force = false, strict = false;

  bool edits() const { return !gains.empty() || !offsets.empty() || !curves.empty(); }
};

bool ParseAssignment(const std::string& text, Assignment& assignment) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) return false;
  assignment.component = text.substr(0, equals);
  const char* begin = text.data() + equals + 1;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(begin, end, assignment.value);
  return result.ec == std::errc() && result.ptr == end && std::isfinite(assignment.value);
}

// What is given but has nothing to act on.
Status CheckIdle(const CLI::App& command, const PoseOptions& o) {
  const auto has_no_effect = [](const std::string& name, const std::string& why) {
    return Status::InvalidArgument(name + " has no effect " + why);
  };
  if (!o.edits() && !o.clip.empty()) {
    return has_no_effect("--clip", "without --gain, --offset or --curve, which say what is edited in it");
  }
  const std::string of_drag = FirstGiven(command, {"--frame", "--price", "--many", "--bounded"});
  if (o.drag.empty() && !of_drag.empty()) {
    return has_no_effect(of_drag, "without --drag: it says how weights are found for what is dragged");
  }
  if (o.many && o.price == 0.0) return has_no_effect("--many", "at --price 0: no component costs anything");
  if (o.no_track && o.weights.empty()) {
    return has_no_effect("--no-track", o.edits() ? "on edits, which leave the motion of the whole as it is"
                                                 : "on --drag: the shape stands where its --frame does");
  }
  if (command.count("--quality") > 0 && !IsStreamName({o.output})) {
    return has_no_effect("--quality", "on " + o.output + ", which is no .sac stream");
  }
  if (o.force && !IsCacheName(o.output) && !IsVatName(o.output)) {
    return has_no_effect("--force", "on " + o.output + ", which has no other file beside it");
  }
  return Status::Ok();
}

Status CheckOptions(const CLI::App& command, const PoseOptions& o) {
  const int ways = (o.weights.empty() ? 0 : 1) + (o.drag.empty() ? 0 : 1) + (o.edits() ? 1 : 0);
  if (ways != 1) return Status::InvalidArgument("one of --weights, --drag, or --gain, --offset and --curve is needed");
  for (const auto& [name, texts] : {std::pair{"--gain", &o.gains}, std::pair{"--offset", &o.offsets}}) {
    for (const std::string& text : *texts) {
      Assignment ignored;
      if (!ParseAssignment(text, ignored)) {
        return Status::InvalidArgument(std::string(name) + ": '" + text + "' is no component and number such as 7=2");
      }
    }
  }
  for (const std::string& text : o.curves) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      return Status::InvalidArgument("--curve: '" + text + "' is no component and file such as 7=curve.csv");
    }
  }
  SAC_RETURN_IF_ERROR(CheckPosedOutput(o.output, !o.drag.empty()));
  SAC_RETURN_IF_ERROR(CheckIdle(command, o));
  std::vector<std::string> inputs = o.clip.empty() || IsStreamName(o.clip) ? o.clip : FilesOfInput(o.clip);
  inputs.push_back(o.components);
  for (const std::string& path : {o.weights, o.drag}) {
    if (!path.empty()) inputs.push_back(path);
  }
  for (const std::string& text : o.curves) inputs.push_back(text.substr(text.rfind('=') + 1));
  return CheckOverwriting(inputs, FilesOfPosed(o.output));
}

Status Named(const PoseOptions& o, const Status& status) {
  return status.ok() ? status : Status(status.code(), o.components + ": " + status.message());
}

// The component that is meant by its number, from 0, or by its name.
Status FindComponent(const PoseOptions& o, const SparseComponents& components, const std::string& text,
                     std::size_t& index) {
  for (std::size_t k = 0; k < components.components.size(); ++k) {
    if (components.components[k].name == text || std::to_string(k) == text) {
      index = k;
      return Status::Ok();
    }
  }
  return Status::InvalidArgument(o.components + ": has no component " + text);
}

// The frames that components pose, one after the other.
class PosedClip : public ClipReader {
 public:
  // `track` is empty, or one a frame.
  PosedClip(const ComponentPoser& poser, std::vector<float> weights, std::vector<RigidPose> track)
      : poser_(poser), weights_(std::move(weights)), track_(std::move(track)) {
    mesh_.triangles = poser.components().triangles;
  }
  Status Start() {
    bool end = false;
    SAC_RETURN_IF_ERROR(Next(mesh_.positions, end));
    return Rewind();
  }
  const Mesh& mesh() const override { return mesh_; }
  FrameRate rate() const override { return poser_.components().rate; }
  std::optional<std::uint32_t> frame_count() const override { return frames(); }
  Status Next(Positions& frame, bool& end) override {
    end = next_ == frames();
    if (end) return Status::Ok();
    const std::size_t count = poser_.components().components.size(), f = next_++;
    const RigidPose pose = track_.empty() ? RigidPose{} : track_[f];
    return poser_.Compose(std::span<const float>(weights_).subspan(f * count, count), pose, frame);
  }
  Status Rewind() override {
    next_ = 0;
    return Status::Ok();
  }

 private:
  std::uint32_t frames() const {
    return static_cast<std::uint32_t>(weights_.size() / poser_.components().components.size());
  }

  const ComponentPoser& poser_;
  std::vector<float> weights_;
  std::vector<RigidPose> track_;
  Mesh mesh_;
  std::uint32_t next_ = 0;
};

Status PoseWeights(const PoseOptions& o, const ComponentPoser& poser) {
  const SparseComponents& c = poser.components();
  std::vector<float> weights;
  SAC_RETURN_IF_ERROR(ReadWeights(o.weights, c.components.size(), weights));
  const std::size_t frames = weights.size() / c.components.size();
  Warnings warnings;
  std::vector<RigidPose> track;
  if (!o.no_track) {
    if (frames == c.frames()) {
      track = c.track;
    } else {
      warnings.push_back(o.weights + ": " + std::to_string(frames) + " frames, but " + o.components + " has " +
                         std::to_string(c.frames()) + ": its rigid motion is left out");
    }
  }
  SAC_RETURN_IF_ERROR(TellWarnings(warnings, o.strict));
  PosedClip clip(poser, std::move(weights), std::move(track));
  SAC_RETURN_IF_ERROR(Named(o, clip.Start()));
  return WritePosed(clip, {o.output, {}, o.quality, o.force, o.strict});
}

Status PoseDrag(const PoseOptions& o, const ComponentPoser& poser) {
  const SparseComponents& c = poser.components();
  std::vector<DragTarget> targets;
  SAC_RETURN_IF_ERROR(ReadDrag(o.drag, targets));
  DragSettings settings;
  if (o.frame) {
    if (*o.frame >= c.frames()) {
      return Status::InvalidArgument(o.components + ": has no frame " + std::to_string(*o.frame));
    }
    const std::size_t count = c.components.size();
    const auto begin = c.weights.begin() + static_cast<std::ptrdiff_t>(*o.frame * count);
    settings.start.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    settings.pose = c.track[*o.frame];
  }
  if (o.price) settings.price = *o.price;
  settings.sparse = !o.many;
  settings.bounded = o.bounded;
  std::vector<float> weights;
  const Status dragged = poser.Drag(targets, settings, weights);
  if (!dragged.ok()) return {dragged.code(), o.drag + ": " + dragged.message()};
  PosedClip clip(poser, weights, {settings.pose});
  SAC_RETURN_IF_ERROR(Named(o, clip.Start()));
  double square = 0;
  for (const DragTarget& target : targets) {
    for (std::size_t a = 0; a < 3; ++a) {
      const double d =
          static_cast<double>(clip.mesh().positions[target.vertex][a]) - static_cast<double>(target.position[a]);
      square += d * d;
    }
  }
  SAC_RETURN_IF_ERROR(WritePosed(clip, {o.output, {}, o.quality, o.force, o.strict}));
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const float start = settings.start.empty() ? 0 : settings.start[k];
    if (weights[k] != start) std::printf("%s = %g\n", c.components[k].name.c_str(), static_cast<double>(weights[k]));
  }
  std::printf("%.6g model units from the targets (RMS)\n", std::sqrt(square / static_cast<double>(targets.size())));
  return Status::Ok();
}

Status MakeEdits(const PoseOptions& o, const SparseComponents& components, std::vector<ComponentEdit>& edits) {
  edits.assign(components.components.size(), {});
  // The component that `text` means, which an option may name once, by its number or its name.
  std::set<std::pair<std::string, std::size_t>> seen;
  const auto find = [&](const std::string& option, const std::string& text, std::size_t& k) -> Status {
    SAC_RETURN_IF_ERROR(FindComponent(o, components, text, k));
    if (seen.emplace(option, k).second) return Status::Ok();
    return Status::InvalidArgument(option + ": " + text + " is there twice, and the second would replace the first");
  };
  const auto assign = [&](const std::string& option, const std::vector<std::string>& texts,
                          double ComponentEdit::*member) -> Status {
    for (const std::string& text : texts) {
      Assignment assignment;
      std::size_t k = 0;
      if (!ParseAssignment(text, assignment)) return Status::InvalidArgument(text);
      SAC_RETURN_IF_ERROR(find(option, assignment.component, k));
      edits[k].*member = assignment.value;
    }
    return Status::Ok();
  };
  SAC_RETURN_IF_ERROR(assign("--gain", o.gains, &ComponentEdit::gain));
  SAC_RETURN_IF_ERROR(assign("--offset", o.offsets, &ComponentEdit::offset));
  for (const std::string& text : o.curves) {
    const std::size_t equals = text.rfind('=');
    std::size_t k = 0;
    SAC_RETURN_IF_ERROR(find("--curve", text.substr(0, equals), k));
    SAC_RETURN_IF_ERROR(ReadWeights(text.substr(equals + 1), 1, edits[k].curve));
  }
  return Status::Ok();
}

Status PoseEdits(const PoseOptions& o, const ComponentPoser& poser) {
  const SparseComponents& c = poser.components();
  std::vector<ComponentEdit> edits;
  SAC_RETURN_IF_ERROR(MakeEdits(o, c, edits));
  ClipArgument original;
  Warnings warnings;
  if (o.clip.empty()) {
    warnings.push_back(o.components +
                       ": without --clip what the components do not say is lost, as wrinkles they have not learnt");
    auto posed = std::make_unique<PosedClip>(poser, c.weights, c.track);
    SAC_RETURN_IF_ERROR(Named(o, posed->Start()));
    original.reader = std::move(posed);
  } else {
    SAC_RETURN_IF_ERROR(OpenClip(o.clip, original));
    warnings = original.warnings;
    if (!original.reader->mesh().normals.empty()) {
      warnings.push_back(original.reader->name() + ": its normals are left out, which the edit makes wrong");
    }
  }
  SAC_RETURN_IF_ERROR(TellWarnings(warnings, o.strict));
  std::unique_ptr<EditedClip> edited;
  SAC_RETURN_IF_ERROR(EditedClip::Create(*original.reader, poser, std::move(edits), edited));
  return WritePosed(*edited, {o.output, original.offset, o.quality, o.force, o.strict});
}

Status Run(const PoseOptions& o) {
  SparseComponents components;
  SAC_RETURN_IF_ERROR(ReadComponents(o.components, components));
  std::unique_ptr<ComponentPoser> poser;
  SAC_RETURN_IF_ERROR(Named(o, ComponentPoser::Create(std::move(components), poser)));
  if (!o.weights.empty()) return PoseWeights(o, *poser);
  return o.drag.empty() ? PoseEdits(o, *poser) : PoseDrag(o, *poser);
}

void AddWays(CLI::App& app, PoseOptions& o) {
  app.add_option("--weights", o.weights, "a table of weights, a line a frame, as sac components writes it")
      ->option_text("FILE.csv");
  app.add_option("--drag", o.drag, "a file of lines `vertex x y z`: where vertices shall be, model units")
      ->option_text("FILE");
  AddNumber(app, "--frame", o.frame, 0u, 0xfffffffeu, "the frame that is dragged [the rest shape]");
  AddNumber(app, "--price", o.price, 0.0, 1e6, "of moving components against missing the targets [0.02]");
  app.add_flag("--many", o.many, "move many components by little, not few");
  app.add_flag("--bounded", o.bounded, "keep weights within what the clip showed");
  app.add_option("--gain", o.gains, "multiply the weights of a component, by number or name; may be repeated")
      ->option_text("K=X");
  app.add_option("--offset", o.offsets, "add to the weights of a component; may be repeated")->option_text("K=X");
  app.add_option("--curve", o.curves, "add a curve, a number a frame, to the weights of a component; may be repeated")
      ->option_text("K=FILE");
  app.add_option("--clip", o.clip,
                 "the clip that is edited, as for encode: it moves by the difference, so that the rest of the "
                 "performance stays as it was captured")
      ->option_text("...");
}

}  // namespace

Command AddPoseCommand(CLI::App& app) {
  auto options = std::make_shared<PoseOptions>();
  CLI::App* command = app.add_subcommand("pose", "Make shapes of components: from weights, by dragging, by editing.");
  command->add_option("COMPONENTS", options->components, "the .npz that sac components wrote")
      ->required()
      ->option_text(" ");
  command
      ->add_option("-o,--output", options->output,
                   "a clip as for decode, or a .sac stream; with --drag also a single mesh")
      ->required()
      ->option_text("OUT");
  AddWays(*command, *options);
  command->add_flag("--no-track", options->no_track, "with --weights: leave out the rigid motion of the clip");
  AddNumber(*command, "--quality", options->quality, 0.0, 100.0, "of a .sac stream [50]");
  command->add_flag("--force", options->force, "replace a mesh that is there beside the cache to write");
  AddStrict(*command, options->strict);
  command->footer(
      "Examples:\n"
      "  sac pose face.npz --weights face.csv -o face2.pc2\n"
      "  sac pose face.npz --drag corners.txt --frame 12 -o smile.obj\n"
      "  sac pose face.npz --gain 7=2 --clip face.obj face.pc2 -o face.sac\n");
  return {command, [options, command] { return CheckOptions(*command, *options); },
          [options] { return Run(*options); }};
}

}  // namespace sac

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "decomposition/rest_alignment.h"
#include "sac/component_poser.h"

namespace sac {
namespace {

bool Changes(const ComponentEdit& edit) { return edit.gain != 1 || edit.offset != 0 || !edit.curve.empty(); }

Status CheckEdits(const SparseComponents& components, std::span<const ComponentEdit> edits) {
  if (!edits.empty() && edits.size() != components.components.size()) {
    return Status::InvalidArgument(std::to_string(edits.size()) + " edits for " +
                                   std::to_string(components.components.size()) + " components");
  }
  for (const ComponentEdit& edit : edits) {
    const bool finite = std::all_of(edit.curve.begin(), edit.curve.end(), [](float x) { return std::isfinite(x); });
    if (!std::isfinite(edit.gain) || !std::isfinite(edit.offset) || !finite) {
      return Status::InvalidArgument("an edit is not finite");
    }
    if (!edit.curve.empty() && edit.curve.size() != components.frames()) {
      return Status::InvalidArgument("a curve of " + std::to_string(edit.curve.size()) + " values for " +
                                     std::to_string(components.frames()) + " frames");
    }
  }
  return Status::Ok();
}

// Edits that have been checked, to a frame that is there.
Status Apply(const ComponentPoser& poser, std::span<const ComponentEdit> edits, std::uint32_t frame,
             Positions& positions) {
  const SparseComponents& c = poser.components();
  const std::size_t count = c.components.size();
  std::vector<float> before(c.weights.begin() + static_cast<std::ptrdiff_t>(frame * count),
                            c.weights.begin() + static_cast<std::ptrdiff_t>((frame + 1) * count));
  std::vector<float> after = before;
  for (std::size_t k = 0; k < edits.size(); ++k) {
    const ComponentEdit& edit = edits[k];
    double w = edit.gain * static_cast<double>(before[k]) + edit.offset;
    if (!edit.curve.empty()) w += static_cast<double>(edit.curve[frame]);
    after[k] = static_cast<float>(w);
  }
  if (after == before) return Status::Ok();
  Positions own, posed;
  SAC_RETURN_IF_ERROR(poser.Compose(before, {}, own));
  SAC_RETURN_IF_ERROR(poser.Compose(after, {}, posed));
  // Only the rotation of the track turns a difference.
  RigidPose turn = c.track[frame];
  turn.translation = {};
  const PositionMatrix change = Moved(MatrixOf(posed) - MatrixOf(own), turn);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (posed[v] == own[v]) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      positions[v][a] = static_cast<float>(static_cast<double>(positions[v][a]) +
                                           change(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(a)));
    }
  }
  return Status::Ok();
}

}  // namespace

Status EditFrame(const ComponentPoser& poser, std::span<const ComponentEdit> edits, std::uint32_t frame,
                 Positions& positions) {
  const SparseComponents& c = poser.components();
  SAC_RETURN_IF_ERROR(CheckEdits(c, edits));
  if (frame >= c.frames()) {
    return Status::InvalidArgument("there is no frame " + std::to_string(frame) + " among " +
                                   std::to_string(c.frames()));
  }
  if (positions.size() != c.rest.size()) {
    return Status::InvalidArgument(std::to_string(positions.size()) + " vertices, not " +
                                   std::to_string(c.rest.size()));
  }
  return Apply(poser, edits, frame, positions);
}

Status EditedClip::Create(ClipReader& clip, const ComponentPoser& poser, std::vector<ComponentEdit> edits,
                          std::unique_ptr<EditedClip>& edited) {
  const SparseComponents& components = poser.components();
  if (clip.mesh().positions.size() != components.rest.size()) {
    return Status::InvalidArgument(AtClip(clip, std::to_string(clip.mesh().positions.size()) +
                                                    " vertices, but the components have " +
                                                    std::to_string(components.rest.size())));
  }
  SAC_RETURN_IF_ERROR(CheckEdits(components, edits));
  std::unique_ptr<EditedClip> made(new EditedClip(clip, poser, std::move(edits)));
  made->mesh_ = clip.mesh();
  SAC_RETURN_IF_ERROR(made->Edit(0, made->mesh_.positions));
  if (std::any_of(made->edits_.begin(), made->edits_.end(), Changes)) {
    made->mesh_.normals.clear();
    made->mesh_.normal_triangles.clear();
  }
  edited = std::move(made);
  return Status::Ok();
}

Status EditedClip::Edit(std::uint32_t frame, Positions& positions) const {
  if (frame >= poser_.components().frames()) {
    return Status::InvalidArgument(AtClip(clip_, "has more frames than the weights"));
  }
  return Apply(poser_, edits_, frame, positions);
}

Status EditedClip::Next(Positions& frame, bool& end) {
  SAC_RETURN_IF_ERROR(clip_.Next(frame, end));
  if (end) return Status::Ok();
  return Edit(next_++, frame);
}

Status EditedClip::Rewind() {
  next_ = 0;
  return clip_.Rewind();
}

}  // namespace sac

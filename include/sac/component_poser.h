// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sac/clip.h"
#include "sac/mesh.h"
#include "sac/sparse_components.h"
#include "sac/status.h"

namespace sac {

// Where a vertex is dragged to, model units.
struct DragTarget {
  std::uint32_t vertex;
  Vec3f position;
};

struct DragSettings {
  // The weights that the shape has before it is dragged; empty: all 0. Their change is what is priced.
  std::vector<float> start;
  RigidPose pose;        // of the shape
  double price = 0.02;   // of moving a component, against missing the targets; 0 or more
  bool sparse = true;    // few components move (prices of |w|), otherwise many by little (of w^2)
  bool bounded = false;  // weights keep the components' bounds; otherwise a drag may go beyond what the clip showed
};

// Turns weights into shapes and shapes into weights. What is prepared serves any number of calls, from several threads
// at once.
class ComponentPoser {
 public:
  // kInvalidArgument where `components` contradict themselves, as a file's may; kLimit where they are too large.
  static Status Create(SparseComponents components, std::unique_ptr<ComponentPoser>& poser);
  ~ComponentPoser();
  ComponentPoser(const ComponentPoser&) = delete;
  ComponentPoser& operator=(const ComponentPoser&) = delete;

  const SparseComponents& components() const;

  // The rest shape deformed by `weights`, one a component, then moved by `pose`; model units. A vertex that no
  // component of weight other than 0 has stays exactly where it is (displacement domain). kInvalidArgument for what is
  // not finite.
  Status Compose(std::span<const float> weights, const RigidPose& pose, Positions& positions) const;

  // The weights within the bounds and the pose with which Compose() comes nearest to `shape`, in the least squares
  // weighted by area. `shape` has the vertices of the rest shape, finite. In the gradient domain by Gauss-Newton.
  Status Fit(std::span<const Vec3f> shape, std::vector<float>& weights, RigidPose& pose) const;

  // Direct manipulation (Lewis and Anjyo 2010): the weights that bring dragged vertices near their targets, at a price
  // for each component in proportion to its size, so that a small one near by is preferred to a large one.
  Status Drag(std::span<const DragTarget> targets, const DragSettings& settings, std::vector<float>& weights) const;

 private:
  class Impl;
  explicit ComponentPoser(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// The weights and the track of another clip of the same mesh, in place of those of `components`. `progress` is called
// after each frame; false ends in kCancelled. kInvalidArgument where the clip has another number of vertices.
Status FitComponents(ClipReader& clip, const SparseComponents& components, std::uint32_t threads,
                     const std::function<bool(std::uint32_t frames)>& progress, SparseComponents& fitted);

// What becomes of a component's weights: gain * weight + offset + curve[frame].
struct ComponentEdit {
  double gain = 1, offset = 0;
  std::vector<float> curve;  // empty, or one a frame
};

// Edits the positions of one frame of the clip whose weights the poser's components have, as EditedClip does.
// kInvalidArgument for a frame that is not there, and for edits that EditedClip refuses.
Status EditFrame(const ComponentPoser& poser, std::span<const ComponentEdit> edits, std::uint32_t frame,
                 Positions& positions);

// A clip whose performance is edited by components. Each frame moves by the difference of what its edited and its own
// weights pose, so that whatever the components do not say stays as it was captured, and a clip without edits stays as
// it is to the last bit.
class EditedClip : public ClipReader {
 public:
  // `clip` and `poser` must live as long. The poser's components have the weights and the track of `clip`; `edits` are
  // empty, or one a component. kInvalidArgument where frames or vertices disagree, or an edit is not finite.
  static Status Create(ClipReader& clip, const ComponentPoser& poser, std::vector<ComponentEdit> edits,
                       std::unique_ptr<EditedClip>& edited);

  // The first frame, edited, with its attributes. Normals are left out where the clip has edits: they would be wrong.
  const Mesh& mesh() const override { return mesh_; }
  FrameRate rate() const override { return clip_.rate(); }
  std::optional<std::uint32_t> frame_count() const override { return clip_.frame_count(); }
  std::string name() const override { return clip_.name(); }
  std::string name_of(std::uint32_t frame) const override { return clip_.name_of(frame); }
  Status Next(Positions& frame, bool& end) override;
  Status Rewind() override;

 private:
  EditedClip(ClipReader& clip, const ComponentPoser& poser, std::vector<ComponentEdit> edits)
      : clip_(clip), poser_(poser), edits_(std::move(edits)) {}
  Status Edit(std::uint32_t frame, Positions& positions) const;

  ClipReader& clip_;
  const ComponentPoser& poser_;
  std::vector<ComponentEdit> edits_;
  Mesh mesh_;
  std::uint32_t next_ = 0;
};

}  // namespace sac
